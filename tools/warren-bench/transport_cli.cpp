// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {

void add_options(CLI::App& app, TransportCommand& command) {
  TransportOptions& options = command.options;
  app.add_option("--bytes", options.bytes, "of the payload")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000'000}))
      ->capture_default_str();
  app.add_option("--rate", options.rate_bit_s, "of the link, bit/s of IP packets")
      ->check(CLI::Range(1e3, 1e9))
      ->capture_default_str();
  app.add_option("--rtt-ms", options.rtt_ms)->check(CLI::Range(0.0, 1e5))->capture_default_str();
  app.add_option("--loss", options.loss, "share of packets, both ways")
      ->check(CLI::Range(0.0, 0.99))
      ->capture_default_str();
  app.add_option("--burst", options.burst_packets, "they are lost in bursts of this mean length")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--blackout-s", options.blackout_s, "after a quarter of the ideal time")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  app.add_option("--queue-ms", options.queue_ms, "of the link; at least ten packets")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  app.add_option("--limit-s", options.limit_s, "gives up a transport that takes longer")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--peers", options.peers)
      ->delimiter(',')
      ->check(CLI::IsMember(transport_kinds()))
      ->capture_default_str();
  app.add_option("--against", options.against,
                 "shares the link with this one, which begins 2 s earlier and never ends")
      ->check(CLI::IsMember(rival_kinds()));
  app.add_option("--runs", options.runs, "figures are medians of so many")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "runs at a time, each on a link of its own")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_flag("--json", command.json, "one JSON object instead of text");
}

void add_options(CLI::App& app, TransportPeerOptions& options) {
  app.group("");  // the benchmark runs it, nobody else
  app.add_option("--kind", options.kind)->required()->check(CLI::IsMember(transport_kinds()));
  app.add_flag("--send", options.sends);
  app.add_option("--address", options.address)->required();
  app.add_option("--bytes", options.bytes)->required();
  app.add_option("--port", options.port);
}

}  // namespace warren
