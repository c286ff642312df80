// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/received_packets.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;

MeshTime at(int ms) { return MeshTime{milliseconds{ms}}; }

std::set<std::uint64_t> numbers(const AckFrame& ack) {
  std::set<std::uint64_t> all;
  for (const NumberRange& range : ack.ranges) {
    for (std::uint64_t number = range.first; number < range.end; ++number) all.insert(number);
  }
  return all;
}

TEST_CASE("what arrived in any order is what the first acknowledgement says") {
  CHECK(rc::check("ranges against a set",
                  [](const std::set<std::uint8_t>& arrived, std::uint32_t seed) {
                    std::vector<std::uint64_t> order(arrived.begin(), arrived.end());
                    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
                    ReceivedPackets received;
                    for (const std::uint64_t number : order)
                      received.on_received(at(1), {number, 100, true});
                    const auto ack = received.take_ack(at(2));
                    RC_ASSERT(ack.has_value() == !arrived.empty());
                    if (!ack) return;
                    RC_ASSERT(ack->ranges.size() <= AckFrame::kRangesMax);
                    RC_ASSERT(ack->ranges.front().end == std::uint64_t{*arrived.rbegin()} + 1);
                    for (std::size_t i = 0; i < ack->ranges.size(); ++i) {
                      RC_ASSERT(ack->ranges[i].first < ack->ranges[i].end);
                      if (i > 0) RC_ASSERT(ack->ranges[i].end < ack->ranges[i - 1].first);
                    }
                    for (const std::uint64_t number : numbers(*ack)) {
                      RC_ASSERT(arrived.count(static_cast<std::uint8_t>(number)) == 1);
                    }
                    if (arrived.size() <= AckFrame::kRangesMax)
                      RC_ASSERT(numbers(*ack).size() == arrived.size());
                  }));
}

TEST_CASE("a packet that asks for no acknowledgement causes none") {
  ReceivedPackets received;
  received.on_received(at(0), {7, 80, false});
  CHECK_FALSE(received.pending());
  CHECK(received.due_at() == kNever);
}

TEST_CASE("two packets are acknowledged at once, one after 25 ms, the last once more") {
  ReceivedPackets received;
  received.on_received(at(1000), {0, 1400, true});
  CHECK(received.due_at() <= at(1025));
  CHECK_FALSE(received.due(at(1000)));
  received.on_received(at(1010), {1, 1400, true});
  CHECK(received.due(at(1010)));
  REQUIRE(received.take_ack(at(1010)));
  CHECK_FALSE(received.pending());
  CHECK(received.due_at() == at(1050));
  REQUIRE(received.take_ack(at(1050)));
  CHECK(received.due_at() == kNever);
}

TEST_CASE("acknowledgements take a small share of a fast link") {
  ReceivedPackets received;
  int acks = 0;
  for (int i = 0; i < 20'000; ++i) {  // 1400 bytes every 100 us: 112 Mbit/s
    const MeshTime now = at(0) + i * Duration{100};
    received.on_received(now, {static_cast<std::uint64_t>(i), 1400, true});
    if (received.due(now)) {
      received.take_ack(now);
      ++acks;
    }
  }
  CHECK(acks <= 1100);
  CHECK(acks >= 100);
}

TEST_CASE("the spacing of neighbours is summed, whatever is lost beside and in whatever order") {
  ReceivedPackets received;
  received.on_received(at(0), {10, 500, true});
  received.on_received(at(10), {11, 600, true});   // 10 ms
  received.on_received(at(100), {13, 700, true});  // 12 is not there
  received.on_received(at(105), {15, 800, true});
  received.on_received(at(111), {14, 900, true});  // 13 to 14: 11 ms; 14 to 15: -6 ms
  const auto ack = received.take_ack(at(120));
  REQUIRE(ack);
  CHECK(ack->pair_bytes == 600 + 900 + 800);
  CHECK(ack->pair_us == 15'000);
  CHECK(ack->arrived_us == 105'000);
  CHECK(ack->delay == milliseconds{15});
}

TEST_CASE("the loss of the peer's packets is told, numbers before the first not counted") {
  ReceivedPackets received;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    if (i % 5 != 0) received.on_received(at(static_cast<int>(i)), {1'000'000 + i, 100, true});
  }
  CHECK(received.loss() == doctest::Approx(0.2).epsilon(0.15));
}

}  // namespace
}  // namespace warren::mesh
