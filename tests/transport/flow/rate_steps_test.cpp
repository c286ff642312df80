// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "measure.hpp"

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

double mean_queue_s(const Transfer& transfer, Duration from, Duration to) {
  double sum = 0.0, packets = 0.0;
  for (const Transfer::Waited& waited : transfer.waited()) {
    const Duration sent = waited.at.time_since_epoch() - waited.queue;
    if (sent < from || sent >= to) continue;
    sum += seconds_of(waited.queue);
    packets += 1.0;
  }
  return sum / std::max(packets, 1.0);
}

double app_rate(Transfer& transfer, Duration from, Duration to) {
  transfer.run_until(from);
  const std::size_t before = transfer.app_bytes_arrived(0);
  transfer.run_until(to);
  return static_cast<double>(transfer.app_bytes_arrived(0) - before) * 8.0 / seconds_of(to - from);
}

TEST_CASE("the link falls from 1 to 0.1 Mbit/s and rises again: followed within 3.5 s") {
  for (const std::size_t buffer : {2U, 10U, 1'000'000U}) {
    for (const Duration rtt : {milliseconds{50}, milliseconds{100}}) {
      std::vector<double> slow, fast, queue;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        TransferConfig config = transfer_config({.rtt = rtt, .buffer_packets = buffer}, seed);
        config.flows = {{}};
        config.there.rate_bit_s = {{Duration{0}, 1e6}, {seconds{10}, 1e5}, {seconds{25}, 1e6}};
        Transfer transfer(config);
        slow.push_back(app_rate(transfer, milliseconds{13'500}, seconds{25}));
        fast.push_back(app_rate(transfer, milliseconds{28'500}, seconds{35}));
        queue.push_back(mean_queue_s(transfer, milliseconds{13'500}, seconds{25}));
      }
      CAPTURE(buffer);
      CAPTURE(rtt.count());
      CHECK(median(slow) >= 0.80e5);
      CHECK(median(fast) >= 0.88e6);
      CHECK(median(queue) <= 0.150);
    }
  }
}

TEST_CASE("a path that becomes longer is not taken for a queue when the link becomes faster") {
  for (const Duration rtt : {milliseconds{100}, milliseconds{270}}) {
    TransferConfig config = transfer_config({.rtt = rtt}, 1);
    config.flows = {{}};
    config.there.rate_bit_s = {{Duration{0}, 5e5}, {seconds{10}, 1e6}};
    config.there.longer = {seconds{10}, milliseconds{30}};
    Transfer transfer(config);
    CAPTURE(rtt.count());
    CHECK(app_rate(transfer, seconds{15}, milliseconds{17'500}) >= 0.8e6);
  }
}

TEST_CASE("after a blackout the old rate is taken up at once") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TransferConfig config = transfer_config({.loss = 0.05}, seed);
    config.flows = {{}};
    config.there.blackout = config.back.blackout = {seconds{10}, seconds{70}};
    Transfer transfer(config);
    transfer.run_until(seconds{71});
    const auto first = transfer.first_arrival_after(seconds{70}, 0);
    REQUIRE(first);
    CHECK(*first - MeshTime{seconds{70}} <= milliseconds{400});
    CHECK(app_rate(transfer, seconds{72}, seconds{77}) >= 0.85e6);
  }
}

TEST_CASE("a source slower than the link does not lower the rate, nor raise it") {
  for (const double loss : {0.0, 0.2}) {
    for (const Duration jitter : {milliseconds{0}, milliseconds{10}}) {
      CAPTURE(loss);
      CAPTURE(jitter.count());
      TransferConfig config = transfer_config({.loss = loss, .jitter = jitter}, 1);
      config.flows = {{.app_bit_s = 2e5, .slow_from = seconds{10}}};
      Transfer transfer(config);
      transfer.run_until(seconds{60});
      const double rate = transfer.sender(0).quality().rate_bit_s;
      CHECK(rate >= 0.85e6);
      CHECK(rate <= 1.3e6);
    }
  }
}

TEST_CASE("clocks that drift and step do no harm") {
  for (const Duration step :
       {Duration{seconds{7}}, Duration{seconds{-7}}, Duration{milliseconds{80}}}) {
    for (const double drift : {5e-5, -5e-5}) {
      CAPTURE(step.count());
      CAPTURE(drift);
      TransferConfig config = transfer_config({.loss = 0.05}, 1);
      config.flows = {{}};
      config.clock_drift = drift;
      config.clock_steps = {{seconds{10}, step}};
      Transfer transfer(config);
      CHECK(app_rate(transfer, seconds{10}, seconds{15}) >= 0.80e6);
      CHECK(app_rate(transfer, seconds{15}, seconds{40}) >= 0.87e6);
      CHECK(mean_queue_s(transfer, seconds{15}, seconds{40}) <= 0.060);
    }
  }
}

}  // namespace
}  // namespace warren::mesh
