// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace warren::control {
class FleetStatus;
}

namespace warren {

// A line for each layer of each node, then the bytes by class: aligned text for people. Times are
// local.
std::string table_of(const control::FleetStatus& status);

}  // namespace warren
