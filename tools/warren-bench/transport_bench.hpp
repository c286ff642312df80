// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/warren-bench/transport_peer.hpp"

namespace warren {

struct TransportOptions {
  std::size_t bytes = 5'000'000;
  double rate_bit_s = 1e6;
  double rtt_ms = 50.0;
  double loss = 0.0;                    // both ways
  std::optional<double> burst_packets;  // then losses come in bursts of this mean length
  double blackout_s = 0.0;              // after a quarter of the payload's ideal time
  double queue_ms = 200.0;              // of the link, by bytes at its rate; at least ten packets
  std::optional<double> limit_s;        // see time_limit_s()
  std::vector<std::string> peers = transport_kinds();
  std::optional<std::string> against;  // another flow on the link, endless
  int runs = 1;
  int jobs = 1;  // runs at a time, each on a link of its own
  std::uint64_t seed = 1;
};

// How long the payload takes at the link's whole rate, without any header.
double ideal_s(const TransportOptions& options);
// A run that takes longer is given up.
double time_limit_s(const TransportOptions& options);

struct TransportRun {
  std::string problem;  // the kernel cannot, or the transport broke; empty otherwise
  bool available = true;
  std::optional<double>
      seconds;              // from the sender's first call to the last byte; none: not by then
  double efficiency = 0.0;  // payload bytes arrived / (R (1 - p) x time), blackout left out
  // With a rival beside: what it got meanwhile, as efficiency; and the share of all payload bytes
  // that was this one's.
  std::optional<double> rival_efficiency;
  std::optional<double> share;
  // Of all that is on the link: with a rival they say nothing of this one.
  double oversend = 0.0;               // IP bytes sent / (payload bytes arrived / (1 - p))
  double back_share = 0.0;             // IP bytes sent the other way / payload bytes arrived
  std::optional<double> first_byte_s;  // after the blackout's end, or after the start
  double sender_cpu = 0.0;  // of one core, user and system; TCP's is partly the kernel's own
  double receiver_cpu = 0.0;
  double link_late_ms_max = 0.0;  // of the emulator: how far it can be trusted
};

struct TransportResult {
  std::string peer;
  TransportRun median;  // each figure's median over the runs; none counts as the longest
  std::vector<TransportRun> runs;
};

tl::expected<std::vector<TransportResult>, std::string> bench_transport(
    const TransportOptions& options);
TransportRun median_of(const std::vector<TransportRun>& runs);

std::string to_text(const std::vector<TransportResult>& results, const TransportOptions& options);
std::string to_json(const std::vector<TransportResult>& results, const TransportOptions& options);

}  // namespace warren
