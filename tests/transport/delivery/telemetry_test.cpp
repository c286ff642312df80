// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/delivery/toy_channel.hpp"
#include "transport/delivery/telemetry_outbox.hpp"
#include "transport/delivery/telemetry_versions.hpp"

using namespace warren;
using namespace warren::mesh;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kRoom = 1200;

struct TelemetryFixture {
  TelemetryBoard board;
  OutboxCounts counts;
  TelemetryOutbox outbox{board, counts};

  void set(std::uint16_t key, std::vector<std::uint8_t> bytes) {
    REQUIRE(board.set(key, bytes));
    outbox.on_set(key);
  }
  TelemetryFrame next() { return std::get<TelemetryFrame>(next_frame().frame); }
  OutgoingFrame next_frame() {
    auto frame = outbox.next(kRoom, kRoom);
    REQUIRE(frame);
    return std::move(*frame);
  }
};

TelemetryTicket ticket_of(const OutgoingFrame& frame) {
  return std::get<TelemetryTicket>(frame.ticket);
}

}  // namespace

TEST_CASE_FIXTURE(TelemetryFixture, "only the latest value is sent, once") {
  set(7, {1});
  set(7, {2});
  CHECK(next().bytes == std::vector<std::uint8_t>{2});
  CHECK_FALSE(outbox.next(kRoom, kRoom));
  CHECK(counts.telemetry_replaced == 1);
}

TEST_CASE_FIXTURE(TelemetryFixture, "a lost value is followed by the current one, not by itself") {
  set(7, {1});
  const OutgoingFrame lost = next_frame();
  CHECK(outbox.empty());
  outbox.on_lost(ticket_of(lost));
  set(7, {2});
  CHECK(next().bytes == std::vector<std::uint8_t>{2});
  outbox.on_lost(ticket_of(lost));
  CHECK(outbox.empty());
}

TEST_CASE_FIXTURE(TelemetryFixture, "what was told lost and came after all does not go again") {
  set(7, {1});
  const OutgoingFrame frame = next_frame();
  outbox.on_lost(ticket_of(frame));
  CHECK_FALSE(outbox.empty());
  outbox.on_acked(ticket_of(frame));
  CHECK(outbox.empty());
}

TEST_CASE_FIXTURE(TelemetryFixture, "a repetition is of the latest value or does not happen") {
  set(7, {1});
  const OutgoingFrame frame = next_frame();
  CHECK(outbox.again(ticket_of(frame)));
  set(7, {2});
  CHECK_FALSE(outbox.again(ticket_of(frame)));
}

TEST_CASE_FIXTURE(TelemetryFixture, "keys take turns, however often one of them is set") {
  set(1, {1});
  for (std::uint16_t key = 2; key <= 4; ++key) set(key, {0});
  std::vector<std::uint16_t> order;
  for (int i = 0; i < 8; ++i) {
    order.push_back(next().key);
    set(1, {1});
    set(4, {0});
  }
  CHECK(order == std::vector<std::uint16_t>{1, 2, 3, 4, 1, 4, 1, 4});
}

TEST_CASE_FIXTURE(TelemetryFixture, "a value that fits into no packet to this peer holds up none") {
  set(1, std::vector<std::uint8_t>(600));
  set(2, {5});
  CHECK(std::get<TelemetryFrame>(outbox.next(100, kRoom)->frame).key == 2);
  CHECK_FALSE(outbox.empty());
  CHECK_FALSE(outbox.next(100, 500));
  CHECK(outbox.empty());
  CHECK(counts.telemetry_oversized == 1);
}

TEST_CASE_FIXTURE(TelemetryFixture, "the board is bounded in keys and in bytes") {
  for (std::uint16_t key = 0; key < TelemetryBoard::kKeysMax; ++key) set(key, {1});
  CHECK_FALSE(board.set(1000, std::vector<std::uint8_t>{1}));
  CHECK(board.set(5, std::vector<std::uint8_t>(TelemetryFrame::kBytesMax)));
  CHECK_FALSE(board.set(5, std::vector<std::uint8_t>(TelemetryFrame::kBytesMax + 1)));
}

TEST_CASE("versions are taken in rising order only, around the wrap too, of a bounded number") {
  TelemetryVersions versions;
  using Verdict = TelemetryVersions::Verdict;
  CHECK(versions.take(1, 0xFFFF'FFFE) == Verdict::kNew);
  CHECK(versions.take(1, 0xFFFF'FFFE) == Verdict::kStale);
  CHECK(versions.take(1, 1) == Verdict::kNew);
  CHECK(versions.take(1, 0xFFFF'FFFF) == Verdict::kStale);
  for (std::uint16_t key = 2; key <= TelemetryVersions::kKeysMax; ++key)
    CHECK(versions.take(key, 0) == Verdict::kNew);
  CHECK(versions.take(1000, 0) == Verdict::kTooManyKeys);
  CHECK(versions.take(2, 1) == Verdict::kNew);
}

TEST_CASE("values never go backwards, and the last one of each key arrives") {
  CHECK(rc::check("values never go backwards", [](std::uint64_t seed) {
    test::ToyPair pair(DeliveryConfig{}, seed);
    pair.faults = {0.3, 0.3, 60ms, false};
    std::map<std::uint16_t, std::uint32_t> last;
    for (std::uint32_t value = 1; value < 300; ++value) {
      const auto key = static_cast<std::uint16_t>(test::below(pair.random(), 5));
      pair.node(0).set_telemetry(key, value);
      last[key] = value;
      if (value == 150) pair.restart(1);
      pair.step();
      if (value == 149) pair.node(1).telemetry.clear();
    }
    for (int step = 0; step < 400; ++step) pair.step();
    for (const auto& [key, value] : last) {
      const auto& arrived = pair.node(1).telemetry[key];
      RC_ASSERT(!arrived.empty());
      RC_ASSERT(arrived.back() == value);
      RC_ASSERT(std::is_sorted(arrived.begin(), arrived.end()));
    }
  }));
}
