// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <iostream>

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>

#include "daemon/cli.hpp"
#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "daemon/config_commands.hpp"
#include "daemon/log.hpp"
#include "daemon/service_manager.hpp"
#include "daemon/warrend.hpp"

namespace {

using namespace warren;

constexpr int kExitFailure = 1;

// SIGHUP again and again; SIGTERM and SIGINT once, after which nothing keeps the signals.
void watch_signals(asio::signal_set& signals, Warrend& warrend) {
  signals.async_wait([&signals, &warrend](std::error_code error, int signal) {
    if (error) return;
    if (signal == SIGHUP) {
      warrend.request_reload();
      watch_signals(signals, warrend);
    } else {
      warrend.request_stop();
    }
  });
}

int execute(const RunCommand& command) {
  const auto config = load_config(command.config);
  if (!config) {
    std::cerr << join_lines(config.error()) << "\n";
    return kExitConfigError;
  }
  start_log(config->log.level, config->log.format);

  asio::io_context io(1);
  asio::signal_set signals(io, SIGTERM, SIGINT, SIGHUP);
  std::signal(SIGPIPE, SIG_IGN);
  const auto warrend = Warrend::start(io, *config, command.config,
                                      {save_map, notify_service_manager, watchdog_time()});
  if (!warrend) {
    log_error(warrend.error());
    return kExitFailure;
  }
  watch_signals(signals, **warrend);
  io.run();
  log_info("stopped");
  return 0;
}

int execute(const CheckCommand& command) { return check_config_command(command.config); }
int execute(const PrintConfigCommand& command) { return print_config_command(command.config); }
int execute(const PrintSampleCommand& command) {
  std::cout << print_sample(command.of_base ? Config::of_base() : Config{});
  return 0;
}
int execute(const ExitCommand& command) { return command.code; }

}  // namespace

int main(int argc, char** argv) {
  return std::visit([](const auto& command) { return execute(command); },
                    parse_command_line(argc, argv));
}
