// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "transport/mesh_address.hpp"

namespace warren::mesh {

// "10.9.0.2:7717" or "[fe80::1]:7717"; nothing if it is neither. Names are not looked up.
std::optional<MeshAddress> parse_mesh_address(std::string_view text);
std::string to_text(const MeshAddress& address);

}  // namespace warren::mesh
