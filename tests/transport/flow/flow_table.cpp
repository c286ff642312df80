// SPDX-License-Identifier: Apache-2.0
// Prints the table of cases that the tests assert, for tuning: flow_table [words in the name].
#include <cstdio>
#include <string>

#include "measure.hpp"

namespace {

using std::chrono::milliseconds;

void row(const std::string& filter, const std::string& name, const warren::mesh::LinkCase& link) {
  if (name.find(filter) == std::string::npos) return;
  const warren::mesh::LinkOutcome outcome = warren::mesh::median_of_five(link);
  std::printf(
      "%-34s efficiency %5.1f %%  oversend %.3f  queue %5.1f ms, p99 %5.1f  acks %4.1f %%\n",
      name.c_str(), 100 * outcome.efficiency, outcome.oversend, 1000 * outcome.queue_mean_s,
      1000 * outcome.queue_99_s, 100 * outcome.ack_share);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string filter = argc > 1 ? argv[1] : "";
  for (const int rtt : {50, 100, 200, 600}) {
    for (const int loss : {0, 5, 20, 40}) {
      row(filter, "1M rtt " + std::to_string(rtt) + " loss " + std::to_string(loss),
          {.rtt = milliseconds{rtt}, .loss = loss / 100.0, .app_bytes = 5'000'000});
    }
    row(filter, "1M rtt " + std::to_string(rtt) + " burst 20",
        {.rtt = milliseconds{rtt}, .loss = 0.2, .burst_packets = 20, .app_bytes = 5'000'000});
  }
  for (const int loss : {0, 5, 20}) {
    const std::string lossy = " loss " + std::to_string(loss);
    const double share = loss / 100.0;
    row(filter, "50k" + lossy, {.rate_bit_s = 5e4, .loss = share, .app_bytes = 200'000});
    row(filter, "10M" + lossy,
        {.rate_bit_s = 1e7, .rtt = milliseconds{20}, .loss = share, .app_bytes = 20'000'000});
    row(filter, "100M" + lossy,
        {.rate_bit_s = 1e8, .rtt = milliseconds{20}, .loss = share, .app_bytes = 50'000'000});
    for (const int jitter : {10, 30}) {
      row(filter, "1M jitter " + std::to_string(jitter) + lossy,
          {.loss = share, .jitter = milliseconds{jitter}, .app_bytes = 5'000'000});
    }
    for (const std::size_t buffer : {2U, 5U}) {
      row(filter, "1M buffer " + std::to_string(buffer) + lossy,
          {.loss = share, .buffer_packets = buffer, .app_bytes = 5'000'000});
    }
  }
}
