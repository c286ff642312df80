// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/fleet_watch.hpp"

#include <chrono>
#include <iostream>
#include <thread>

#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/failure.hpp"
#include "tools/warrenctl/fleet_table.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::chrono::seconds kBetween{1};
constexpr const char* kClearScreen = "\x1b[H\x1b[2J";

void show(const control::FleetStatus& status, bool json) {
  if (json) {
    std::cout << json_line_of(status);
  } else {
    std::cout << kClearScreen << table_of(status);
  }
  std::cout << std::flush;
}

}  // namespace

int watch_fleet(bool json, const std::string& socket) {
  control::Request request;
  request.mutable_fleet_status();
  auto response = ask_daemon(socket, request);
  if (!response) return failure(response.error());
  bool answered = true;
  while (std::cout) {
    if (response) show(response->fleet_status(), json);
    if (!response && answered)
      std::cerr << "warrenctl: " << response.error() << "; waiting for it\n";
    answered = response.has_value();
    std::this_thread::sleep_for(kBetween);
    response = ask_daemon(socket, request);
  }
  return 0;
}

}  // namespace warren
