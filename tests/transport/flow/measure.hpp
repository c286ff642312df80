// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include "transfer.hpp"

namespace warren::mesh {

inline double seconds_of(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct LinkCase {
  double rate_bit_s = 1e6;
  Duration rtt = std::chrono::milliseconds{100};
  double loss = 0.0;
  double burst_packets = 0.0;
  Duration jitter{};
  std::size_t buffer_packets = 1'000'000;
  std::size_t app_bytes = 2'000'000;
};

struct LinkOutcome {
  double efficiency = 0.0;    // application bytes / (R (1 - p) t)
  double oversend = 0.0;      // bytes sent / bytes needed at that loss with packets of that size
  double queue_mean_s = 0.0;  // waited by the packets that arrived
  double queue_99_s = 0.0;
  double ack_share = 0.0;  // of the link's rate
};

inline TransferConfig transfer_config(const LinkCase& link, std::uint64_t seed) {
  TransferConfig config;
  config.seed = seed;
  config.there.rate_bit_s = config.back.rate_bit_s = {{Duration{0}, link.rate_bit_s}};
  config.there.delay = config.back.delay = link.rtt / 2;
  config.there.loss = config.back.loss = link.loss;
  config.there.burst_packets = config.back.burst_packets = link.burst_packets;
  config.there.jitter = config.back.jitter = link.jitter;
  config.there.buffer_packets = link.buffer_packets;
  config.flows = {{.app_bytes = link.app_bytes}};
  return config;
}

inline LinkOutcome run_case(const LinkCase& link, std::uint64_t seed) {
  Transfer transfer(transfer_config(link, seed));
  transfer.run();
  LinkOutcome outcome;
  if (!transfer.finished(0)) return outcome;
  const double took = seconds_of(transfer.finished(0)->time_since_epoch());
  const auto bytes = static_cast<double>(link.app_bytes);
  const double packet = std::clamp(std::sqrt(80.0 * link.rate_bit_s / 8.0 * 0.66), 300.0, 1428.0);
  const double needed = bytes * packet / (packet - Transfer::kOverhead) / (1.0 - link.loss);
  outcome.efficiency = bytes * 8.0 / (link.rate_bit_s * (1.0 - link.loss) * took);
  outcome.oversend = static_cast<double>(transfer.data_bytes_sent(0)) / needed;
  outcome.ack_share = static_cast<double>(transfer.ack_bytes_sent()) * 8.0 / took / link.rate_bit_s;
  std::vector<double> waited;
  for (const Transfer::Waited& packet_waited : transfer.waited()) {
    waited.push_back(seconds_of(packet_waited.queue));
    outcome.queue_mean_s += waited.back();
  }
  outcome.queue_mean_s /= static_cast<double>(waited.size());
  std::sort(waited.begin(), waited.end());
  outcome.queue_99_s = waited[waited.size() * 99 / 100];
  return outcome;
}

// Medians over the seeds 1 to 5.
inline LinkOutcome median_of_five(const LinkCase& link) {
  std::vector<LinkOutcome> runs;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) runs.push_back(run_case(link, seed));
  const auto middle = [&](double LinkOutcome::*member) {
    std::vector<double> values;
    for (const LinkOutcome& run : runs) values.push_back(run.*member);
    return median(values);
  };
  return {middle(&LinkOutcome::efficiency), middle(&LinkOutcome::oversend),
          middle(&LinkOutcome::queue_mean_s), middle(&LinkOutcome::queue_99_s),
          middle(&LinkOutcome::ack_share)};
}

}  // namespace warren::mesh
