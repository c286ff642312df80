// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/warrenctl/layer_commands.hpp"

namespace warren {

// Follows the daemon's layer and prints what its diff-maps take, beside the encoding that Warren's
// predecessor flew. Returns the exit code.
int run(const LayerWatchCommand& command, const std::string& socket);

}  // namespace warren
