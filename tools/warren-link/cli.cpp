// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {
namespace {

constexpr std::size_t kNodesMax = 250;

void add_options(CLI::App& app, LinkOptions& options, bool& tun) {
  auto* const tun_flag =
      app.add_flag("--tun", tun, "two nodes joined by a link of IP packets (the default)");
  app.add_flag("--tap", options.ethernet, "a switch of Ethernet frames: ARP, broadcast, multicast")
      ->excludes(tun_flag);
  app.add_option("--nodes", options.nodes)->check(CLI::Range(std::size_t{2}, kNodesMax));
  app.add_flag("--shared-airtime", options.shared_airtime, "one node sends at a time");
  for (const LinkSetting& setting : kLinkSettings) {
    app.add_option(std::string("--") + setting.name, options.link.*(setting.value), setting.help)
        ->check(CLI::Range(setting.least, setting.most))
        ->capture_default_str();
  }
  app.add_option("--link", options.overrides, "one direction: FROM,TO,NAME=VALUE,.. as above");
  app.add_option("--blackout", options.blackouts_s, "FROM UNTIL, s since the start");
  app.add_option(
      "--trace", options.trace,
      "file of rate, loss and delay over time, of mahimahi, Rutgers or warren-sim radio");
  app.add_option("--trace-back", options.trace_back, "another one for node 1 to node 0");
  app.add_option("--queue-packets", options.queue_packets, "of each node")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--queue-bytes", options.queue_bytes);
  app.add_option("--queue-ms", options.queue_ms, "how long a new packet would wait");
  app.add_option("--seconds", options.seconds, "ends after so long");
  app.add_option("--neighbour-retry-ms", options.neighbour_retry_ms,
                 "between ARP and ND requests; the kernel's default is 1000");
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--stats", options.stats, "file for the counts; standard output otherwise");
  app.add_flag("--control", options.control, "takes off, on, stats and quit from standard input");
  app.add_option("command", options.command, "after --; run in every node")->expected(-1);
}

}  // namespace

std::variant<LinkOptions, ExitCommand> parse_command_line(int argc, char** argv) {
  CLI::App app(
      "Joins network namespaces of its own by emulated radio. A command runs in each (WARREN_NODE "
      "is its number); without one the namespaces stay until the program ends.");
  LinkOptions options;
  bool tun = false;
  add_options(app, options, tun);
  try {
    app.parse(argc, argv);
    if (!options.ethernet && options.nodes != 2) {
      throw CLI::ValidationError("--nodes", "more than two need --tap");
    }
  } catch (const CLI::ParseError& error) {
    return ExitCommand{app.exit(error) == 0 ? 0 : 2};
  }
  return options;
}

}  // namespace warren
