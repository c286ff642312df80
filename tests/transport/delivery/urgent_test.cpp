// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/delivery/toy_channel.hpp"
#include "transport/delivery/urgent_outbox.hpp"
#include "transport/delivery/urgent_window.hpp"

using namespace warren;
using namespace warren::mesh;
using namespace std::chrono_literals;

namespace {

constexpr MeshTime kStart{1s};
constexpr Duration kRtt = 100ms;
const std::vector<std::uint8_t> kStop{1, 2, 3};

struct UrgentFixture {
  OutboxCounts counts;
  UrgentOutbox outbox{UrgentConfig{}, counts};
};

std::uint32_t number_of(const std::optional<OutgoingFrame>& frame) {
  return std::get<UrgentFrame>(frame.value().frame).number;
}

}  // namespace

TEST_CASE_FIXTURE(UrgentFixture,
                  "an urgent message goes at once and in spaced copies, then each "
                  "round trip, until it is stale") {
  outbox.send(kStart, kStop);
  std::vector<Duration> sent_after;
  for (MeshTime now = kStart; now < kStart + 3s; now += 1ms) {
    if (outbox.next(now, 1000, kRtt)) sent_after.push_back(now - kStart);
  }
  REQUIRE(sent_after.size() == 22);  // at 0, 15, 30, 130, ..., 1930 ms
  CHECK(sent_after[0] == 0ms);
  CHECK(sent_after[1] == 15ms);
  CHECK(sent_after[2] == 30ms);
  CHECK(sent_after[3] == 130ms);
  CHECK(sent_after.back() == 1930ms);
  CHECK(counts.urgent_expired == 1);
  CHECK(counts.urgent_copies == 21);
  CHECK(outbox.next_due() == kNever);
}

TEST_CASE_FIXTURE(UrgentFixture, "an acknowledgement stops the copies of that message alone") {
  outbox.send(kStart, kStop);
  outbox.send(kStart, kStop);
  const auto first = outbox.next(kStart, 1000, kRtt);
  CHECK(number_of(outbox.next(kStart, 1000, kRtt)) != number_of(first));
  CHECK_FALSE(outbox.next(kStart, 1000, kRtt));
  outbox.on_acked(std::get<UrgentTicket>(first->ticket));
  CHECK(outbox.unacknowledged() == 1);
  CHECK(outbox.next_due() == kStart + 15ms);
  CHECK(number_of(outbox.next(kStart + 20ms, 1000, kRtt)) != number_of(first));
  CHECK_FALSE(outbox.next(kStart + 20ms, 1000, kRtt));
}

TEST_CASE_FIXTURE(UrgentFixture, "of too many unacknowledged messages the oldest are dropped") {
  for (int i = 0; i < 130; ++i) outbox.send(kStart, kStop);
  CHECK(outbox.unacknowledged() == 128);
  CHECK(counts.urgent_superseded == 2);
  CHECK(number_of(outbox.next(kStart, 1000, kRtt)) == 2);
}

TEST_CASE_FIXTURE(UrgentFixture, "an urgent message that does not fit waits") {
  outbox.send(kStart, kStop);
  CHECK_FALSE(outbox.next(kStart, 5, kRtt));
  CHECK(outbox.next(kStart, 6, kRtt));
}

TEST_CASE("the window takes each number once, whatever the order, around the wrap too") {
  CHECK(rc::check("each number once", [](std::uint32_t start) {
    const auto steps =
        *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange<std::uint32_t>(0, 3000));
    UrgentWindow window;
    std::set<std::uint64_t> taken;
    const std::uint64_t base = (std::uint64_t{1} << 32) + start;
    std::optional<std::uint64_t> latest;
    for (const std::uint32_t step : steps) {
      const std::uint64_t number = base + step;
      const bool too_old = latest && number + UrgentWindow::kWidth <= *latest;
      const bool is_new = !too_old && taken.insert(number).second;
      RC_ASSERT(window.take(static_cast<std::uint32_t>(number)) == is_new);
      if (!latest || number > *latest) latest = number;
    }
  }));
}

TEST_CASE("urgent messages arrive once, at 40 percent loss too") {
  CHECK(rc::check("urgent messages arrive once", [](std::uint64_t seed) {
    test::ToyPair pair(DeliveryConfig{}, seed);
    pair.faults = {0.4, 0.2, 40ms, false};
    for (std::uint32_t number = 0; number < 40; ++number) {
      pair.node(0).send_urgent(pair.now(), number);
      for (int step = 0; step < 4; ++step) pair.step();
    }
    for (int step = 0; step < 400; ++step) pair.step();
    auto arrived = pair.node(1).urgent;
    std::sort(arrived.begin(), arrived.end());
    RC_ASSERT(std::adjacent_find(arrived.begin(), arrived.end()) == arrived.end());
    RC_ASSERT(arrived.size() == 40U);
  }));
}
