// SPDX-License-Identifier: Apache-2.0
#include "tools/link/link_model.hpp"

#include <set>

#include <doctest/doctest.h>

#include "tests/tools/link/link_driver.hpp"

using namespace warren;
using namespace std::chrono_literals;

namespace {

LinkModelConfig at_rate(double bit_s) {
  LinkModelConfig config;
  config.link.capacity = Capacity(bit_s);
  config.link.delay = 20ms;
  return config;
}

}  // namespace

TEST_CASE("a packet arrives after its airtime and the delay") {
  LinkModel model(at_rate(1e6));
  model.send(at_us(1000), packet_of(1250));
  CHECK(model.next_event() == at_us(11'000));  // its airtime ends: nothing to take yet
  CHECK(!model.poll(at_us(30'999)));
  CHECK(model.next_event() == at_us(31'000));
  const auto delivery = model.poll(at_us(31'000));
  REQUIRE(delivery);
  CHECK(delivery->at == at_us(31'000));
  CHECK(model.next_event() == kNever);
}

TEST_CASE("the rate holds to a thousandth, at every rate, for any size") {
  for (const double bit_s : {50e3, 1e6, 10e6, 100e6}) {
    for (const std::size_t bytes : {40U, 333U, 1428U}) {
      auto config = at_rate(bit_s);
      config.link.delay = {};
      config.queue.packets = 20'000;
      LinkModel model(config);
      for (int i = 0; i < 10'000; ++i) model.send(at_us(0), packet_of(bytes));
      const auto all = arrivals_until(model, at_us(3'600'000'000));
      REQUIRE(all.size() == 10'000);
      const double seconds = std::chrono::duration<double>(all.back().at - at_us(0)).count();
      CHECK(8e4 * static_cast<double>(bytes) / seconds == doctest::Approx(bit_s).epsilon(0.001));
    }
  }
}

TEST_CASE("the queue's limits drop the newest: packets, bytes, time") {
  auto config = at_rate(1e6);
  SUBCASE("packets") { config.queue.packets = 5; }
  SUBCASE("bytes") { config.queue.bytes = 6250; }
  SUBCASE("time: 4 that wait take 40 ms, and one is on the air") { config.queue.time = 45ms; }
  LinkModel model(config);
  for (int i = 0; i < 20; ++i) model.send(at_us(0), packet_of(1250));
  CHECK(model.counts(0, 1).dropped_queue_full == 15);
  CHECK(arrivals_until(model, at_us(1'000'000)).size() == 5);
  CHECK(model.counts(0).queue_time_max == 40ms);
}

TEST_CASE("a queue limited in time drops by the present rate") {
  auto config = at_rate(1e6);
  config.link.capacity = Capacity({{0s, 1e6}, {1s, 1e5}});
  config.queue.time = 100ms;
  LinkModel model(config);
  for (int i = 0; i < 20; ++i) model.send(at_us(0), packet_of(1250));
  CHECK(arrivals_until(model, at_us(1'000'000)).size() == 11);
  for (int i = 0; i < 20; ++i) model.send(at_us(1'000'000), packet_of(1250));
  CHECK(arrivals_until(model, at_us(9'000'000)).size() == 2);
}

TEST_CASE("each station has airtime of its own, or all share one in turn") {
  for (const bool shared : {false, true}) {
    auto config = at_rate(1e6);
    config.stations = 4;
    config.shared_airtime = shared;
    LinkModel model(config);
    for (int i = 0; i < 100; ++i) {
      for (StationIndex from = 0; from < 3; ++from) model.send(at_us(0), packet_of(1250, from, 3));
    }
    const auto all = arrivals_until(model, at_us(60'000'000));
    REQUIRE(all.size() == 300);
    CHECK(all.back().at == at_us(shared ? 3'020'000 : 1'020'000));
    std::set<StationIndex> first_turn;
    for (int i = 0; i < 3; ++i) first_turn.insert(all[static_cast<std::size_t>(i)].from);
    CHECK(first_turn.size() == 3);
  }
}

TEST_CASE("a group packet takes its airtime once and is lost by each receiver on its own") {
  auto config = at_rate(1e6);
  config.stations = 5;
  config.link.loss = 0.5;
  LinkModel model(config);
  for (int i = 0; i < 1000; ++i) model.send(at_us(i * 10'000), packet_of(1250, 0, kEveryStation));
  const auto all = arrivals_until(model, at_us(60'000'000));
  CHECK(all.size() == doctest::Approx(2000).epsilon(0.08));
  CHECK(model.counts(0).sent_packets == 1000);
  int in_common = 0;  // with independent losses a quarter of the packets reach both 1 and 2
  std::set<MeshTime> first;
  for (const auto& delivery : all) {
    CHECK(delivery.group);
    if (delivery.to == 1) first.insert(delivery.at);
    if (delivery.to == 2) in_common += first.contains(delivery.at) ? 1 : 0;
  }
  CHECK(in_common == doctest::Approx(250).epsilon(0.25));
}

TEST_CASE("a group packet goes at the pace of the slowest receiver") {
  auto config = at_rate(1e6);
  config.stations = 3;
  config.link.delay = {};
  LinkModel model(config);
  LinkConfig slow = config.link;
  slow.capacity = Capacity(1e5);
  model.set_link(at_us(0), 0, 2, slow);
  model.send(at_us(0), packet_of(1250, 0, kEveryStation));
  const auto all = arrivals_until(model, at_us(1'000'000));
  REQUIRE(all.size() == 2);
  CHECK(all[0].at == at_us(100'000));
}

TEST_CASE("a packet over the MTU is dropped before it takes airtime") {
  auto config = at_rate(1e6);
  config.link.mtu_bytes = 300;
  LinkModel model(config);
  model.send(at_us(0), packet_of(301));
  model.send(at_us(0), packet_of(300));
  const auto all = arrivals_until(model, at_us(1'000'000));
  REQUIRE(all.size() == 1);
  CHECK(all[0].at == at_us(22'400));
  CHECK(model.counts(0, 1).dropped_too_large == 1);
}

TEST_CASE("a link that changes keeps what is in the air") {
  LinkModel model(at_rate(1e6));
  model.send(at_us(0), packet_of(1250));
  model.send(at_us(0), packet_of(1250));
  LinkConfig fast = at_rate(1e8).link;
  fast.delay = {};
  model.set_link(at_us(5000), 0, 1, fast);
  const auto all = arrivals_until(model, at_us(1'000'000));
  REQUIRE(all.size() == 2);
  CHECK(all[0].at == at_us(10'000));
  CHECK(all[1].at == at_us(10'100));
}

TEST_CASE("what waits at rate 0 goes on when the link is changed") {
  LinkModel model(at_rate(0.0));
  model.send(at_us(0), packet_of(1250));
  CHECK(arrivals_until(model, at_us(1'000'000)).empty());
  CHECK(model.next_event() == kNever);
  model.set_link(at_us(2'000'000), 0, 1, at_rate(1e6).link);
  const auto all = arrivals_until(model, at_us(9'000'000));
  REQUIRE(all.size() == 1);
  CHECK(all[0].at == at_us(2'030'000));
}

TEST_CASE("every packet is accounted for") {
  auto config = at_rate(5e5);
  config.queue.packets = 10;
  config.link.loss = 0.1;
  config.link.burst_loss = BurstLoss{0.1, 5};
  config.link.duplicate = 0.05;
  config.link.loss_pattern = {{false, false, true}, 0ms};
  config.link.blackouts = {{2s, 3s}};
  LinkModel model(config);
  const auto all = send_evenly(model, 1000, 10ms);
  const LinkCounts& counts = model.counts(0, 1);
  CHECK(counts.offered_packets == 1000);
  CHECK(counts.delivered_packets == all.size());
  CHECK(counts.delivered_bytes == 1000 * all.size());
  CHECK(counts.dropped_queue_full > 0);
  CHECK(counts.dropped_blackout > 0);
  CHECK(counts.dropped_loss > 0);
  CHECK(counts.dropped_burst > 0);
  CHECK(counts.dropped_pattern > 0);
  CHECK(counts.offered_packets == counts.delivered_packets - counts.duplicated +
                                      counts.dropped_queue_full + counts.dropped_blackout +
                                      counts.dropped_loss + counts.dropped_burst +
                                      counts.dropped_pattern);
}

TEST_CASE("the same seed gives the same deliveries, another seed others") {
  auto config = at_rate(1e6);
  config.link.loss = 0.2;
  config.link.jitter = 5ms;
  config.link.corrupt = 0.1;
  const auto run = [&](std::uint64_t seed) {
    config.seed = seed;
    LinkModel model(config);
    std::vector<std::pair<MeshTime, std::vector<std::uint8_t>>> seen;
    for (auto& delivery : send_evenly(model, 500, 10ms))
      seen.push_back({delivery.at, delivery.bytes});
    return seen;
  };
  CHECK(run(1) == run(1));
  CHECK(run(1) != run(2));
}
