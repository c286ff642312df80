// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "daemon/config/config.hpp"
#include "daemon/fleet/fleet.hpp"

namespace warren {

// What this node was in its life before.
struct NodeStart {
  StoredMap map;
  FleetStart fleet;
};

// Opens the store that the config names, takes out what is in it, and logs what it found. All is
// empty without a store. The error says what to do.
tl::expected<NodeStart, std::string> start_node(const Config& config);

}  // namespace warren
