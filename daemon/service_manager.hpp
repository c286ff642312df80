// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace warren {

// systemd, where there is one; elsewhere these do nothing.
void notify_service_manager(const std::string& state);
// How often it wants to hear WATCHDOG=1.
std::optional<std::chrono::microseconds> watchdog_time();

}  // namespace warren
