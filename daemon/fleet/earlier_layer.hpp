// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "core/layer/replica.hpp"

namespace warren {

// A layer of an earlier mission: of a .layer file, or of an OctoMap tree (.bt, .ot) as a layer of
// nobody, in the fleet frame. The error names the file.
tl::expected<Replica, std::string> read_earlier_layer(const std::filesystem::path& file);

}  // namespace warren
