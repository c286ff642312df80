// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "transport/mesh_address.hpp"

namespace warren::mesh {

// A network interface as it is now.
struct LinkState {
  unsigned index = 0;    // 0: there is none of that name. It changes when it is made anew
  bool up = false;       // switched on
  bool running = false;  // and has a carrier
  bool has_ipv4 = false;
  bool has_ipv6 = false;
  std::vector<MeshAddress> broadcasts;  // directed ones, without port
  friend bool operator==(const LinkState&, const LinkState&) = default;
};

// Nothing if the kernel could not tell, as without a descriptor left.
std::optional<LinkState> read_link_state(const std::string& name);

}  // namespace warren::mesh
