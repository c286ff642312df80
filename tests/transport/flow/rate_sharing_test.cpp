// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "measure.hpp"

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct Shares {
  double jain = 0.0, sum_bit_s = 0.0, queue_s = 0.0;
};

Shares two_flows(double rate_bit_s, Duration latecomer, double loss, std::uint64_t seed) {
  TransferConfig config = transfer_config({.rate_bit_s = rate_bit_s, .loss = loss}, seed);
  config.flows = {{}, {.start = latecomer}};
  Transfer transfer(config);
  const Duration from = latecomer + seconds{10}, to = from + seconds{40};
  transfer.run_until(from);
  const double a0 = static_cast<double>(transfer.app_bytes_arrived(0));
  const double b0 = static_cast<double>(transfer.app_bytes_arrived(1));
  transfer.run_until(to);
  const double a = static_cast<double>(transfer.app_bytes_arrived(0)) - a0;
  const double b = static_cast<double>(transfer.app_bytes_arrived(1)) - b0;
  Shares shares;
  shares.jain = (a + b) * (a + b) / (2.0 * (a * a + b * b));
  shares.sum_bit_s = (a + b) * 8.0 / seconds_of(to - from);
  double packets = 0.0;
  for (const Transfer::Waited& waited : transfer.waited()) {
    if (waited.at < MeshTime{from}) continue;
    shares.queue_s += seconds_of(waited.queue);
    packets += 1.0;
  }
  shares.queue_s /= packets;
  return shares;
}

TEST_CASE("two flows share a link fairly, whoever came first, and keep its queue short") {
  for (const Duration latecomer : {Duration{0}, Duration{seconds{5}}, Duration{seconds{15}}}) {
    for (const double loss : {0.0, 0.1}) {
      std::vector<double> jain, sum, queue;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Shares shares = two_flows(1e6, latecomer, loss, seed);
        jain.push_back(shares.jain);
        sum.push_back(shares.sum_bit_s);
        queue.push_back(shares.queue_s);
      }
      CAPTURE(latecomer.count());
      CAPTURE(loss);
      CHECK(median(jain) >= 0.9);
      CHECK(median(sum) >= 0.92e6 * (1.0 - loss));
      CHECK(median(queue) <= 0.080);
    }
  }
}

}  // namespace
}  // namespace warren::mesh
