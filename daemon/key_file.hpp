// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "transport/wire/key_schedule.hpp"

namespace warren {

// The secret of a fleet in a file of one line, "warren-fleet-key-1 " and 64 hexadecimal digits. The
// errors name the file and say what to do.

// Refuses a file that anybody but its owner may read or write.
tl::expected<mesh::Key, std::string> read_key_file(const std::filesystem::path& file);
// A fresh random key, for the owner's eyes only. Refuses to replace anything.
tl::expected<void, std::string> make_key_file(const std::filesystem::path& file);

}  // namespace warren
