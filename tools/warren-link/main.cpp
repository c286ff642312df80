// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>

#include "tools/warren-link/cli.hpp"
#include "tools/warren-link/event_loop.hpp"
#include "tools/warren-link/namespaces.hpp"
#include "tools/warren-link/report.hpp"

namespace {

using namespace warren;

int fail(const std::string& why) {
  std::fprintf(stderr, "warren-link: %s\n", why.c_str());
  return 2;
}

void print(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

int execute(const ExitCommand& command) { return command.code; }

int execute(const LinkOptions& options) {
  auto checked = make_model(options, MeshTime{});
  if (!checked) return fail(checked.error());
  prepare_process();
  Namespaces namespaces;
  std::vector<FileDescriptor> devices;
  for (std::size_t node = 0; node < options.nodes; ++node) {
    auto device = namespaces.add({node, options.ethernet, options.neighbour_retry_ms});
    if (!device) return fail(device.error());
    devices.push_back(std::move(*device));
    print("node " + std::to_string(node) + " " + namespaces.name(node) + " " + ipv4_of(node) + " " +
          ipv6_of(node));
  }
  const MeshTime start = monotonic_now();
  Emulator emulator(*make_model(options, start), std::move(devices), options.ethernet);
  NodeCommands commands;
  for (std::size_t node = 0; !options.command.empty() && node < options.nodes; ++node) {
    if (!commands.start(namespaces.name(node), options.command, node, options.nodes)) {
      return fail("cannot start the command");
    }
  }
  const auto stats = [&] { return to_json(emulator, namespaces, monotonic_now() - start); };
  LoopConfig loop;
  loop.ends_with_commands = !options.command.empty();
  loop.control = options.control;
  loop.print_stats = [&] { print(stats()); };
  if (options.seconds)
    loop.end = start + Duration(static_cast<std::int64_t>(*options.seconds * 1e6));
  print("ready");
  run_loop(emulator, commands, loop);
  if (options.stats.empty()) {
    print(stats());
  } else if (!(std::ofstream(options.stats) << stats() << '\n')) {
    return fail("cannot write " + options.stats);
  }
  return commands.exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  return std::visit([](const auto& command) { return execute(command); },
                    parse_command_line(argc, argv));
}
