// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/warrenctl/fleet_commands.hpp"

namespace CLI {
class App;
}

namespace warren {

// The commands that concern other nodes; afterwards, which one was given.
class FleetCli {
 public:
  // `fleet` is the group of that name; this must not move before the command line is parsed.
  FleetCli(CLI::App& app, CLI::App& fleet);
  FleetCli(const FleetCli&) = delete;
  FleetCli& operator=(const FleetCli&) = delete;

  std::optional<FleetCommand> parsed() const;

 private:
  void add_messages(CLI::App& app);
  void add_align(CLI::App& app);
  CLI::App* add_order(CLI::App& fleet, const char* name, const char* text, const char* subject);

  MessageSendCommand send_;
  std::string class_ = "normal";
  bool to_all_ = false;
  MessageWatchCommand watch_;
  std::string subject_;
  std::vector<double> shift_;  // x y z yaw
  bool estimate_ = false;
  std::string against_;
  bool json_ = false;
  CLI::App* send_command_ = nullptr;
  CLI::App* watch_command_ = nullptr;
  CLI::App* retract_ = nullptr;
  CLI::App* restore_ = nullptr;
  CLI::App* clear_ = nullptr;
  CLI::App* align_ = nullptr;
  CLI::App* trajectory_ = nullptr;
};

}  // namespace warren
