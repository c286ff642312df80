// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/warrenctl/fleet_commands.hpp"

namespace warren {

// Prints what has come, then what comes, until its time is over or the daemon ends.
int watch_messages(const MessageWatchCommand& command, const std::string& socket);

}  // namespace warren
