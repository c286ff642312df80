// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace warren {

// Shows the fleet's status every second: as a table over the one before, or as a JSON object per
// line. A daemon that ends is waited for, once it has answered. Returns the exit code when nobody
// reads any more.
int watch_fleet(bool json, const std::string& socket);

}  // namespace warren
