// SPDX-License-Identifier: Apache-2.0
#include "daemon/service_manager.hpp"

#include <systemd/sd-daemon.h>

namespace warren {

void notify_service_manager(const std::string& state) { sd_notify(0, state.c_str()); }

std::optional<std::chrono::microseconds> watchdog_time() {
  std::uint64_t time_us = 0;
  if (sd_watchdog_enabled(0, &time_us) <= 0) return std::nullopt;
  return std::chrono::microseconds(time_us);
}

}  // namespace warren
