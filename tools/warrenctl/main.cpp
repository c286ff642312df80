// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <iostream>

#include "daemon/config_commands.hpp"
#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/cli.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace {

using namespace warren;

constexpr int kExitFailure = 1;

// Asks, then shows what `show` makes of the response.
template <typename Show>
int ask_and_show(const std::string& socket, const control::Request& request, const Show& show) {
  const auto response = ask_daemon(socket, request);
  if (!response) {
    std::cerr << "warrenctl: " << response.error() << "\n";
    return kExitFailure;
  }
  std::cout << show(*response);
  return 0;
}

struct Executor {
  const std::string& socket;

  int operator()(const StatusCommand& command) const {
    control::Request request;
    request.mutable_status();
    return ask_and_show(socket, request, [&](const control::Response& response) {
      return command.json ? json_of(response.status()) : table_of(response.status());
    });
  }
  int operator()(const MapInfoCommand& command) const {
    control::Request request;
    request.mutable_map_info();
    return ask_and_show(socket, request, [&](const control::Response& response) {
      return command.json ? json_of(response.map_info()) : table_of(response.map_info());
    });
  }
  int operator()(const MapSaveCommand& command) const {
    control::Request request;
    // The daemon's working directory is another one.
    request.mutable_map_save()->set_path(std::filesystem::absolute(command.file).string());
    return ask_and_show(socket, request, [](const control::Response& response) {
      return sentence_of(response.map_saved());
    });
  }
  int operator()(const ConfigCheckCommand& command) const {
    return check_config_command(command.file);
  }
  int operator()(const ConfigPrintCommand& command) const {
    if (!command.file.empty()) return print_config_command(command.file);
    control::Request request;
    request.mutable_config_print();
    return ask_and_show(socket, request,
                        [](const control::Response& response) { return response.config().yaml(); });
  }
  int operator()(const ExitCommand& command) const { return command.code; }
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  const CtlArguments arguments = parse_command_line(argc, argv);
  return std::visit(Executor{arguments.socket}, arguments.command);
}
