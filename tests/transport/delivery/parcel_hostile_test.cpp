// SPDX-License-Identifier: Apache-2.0
// An authenticated peer that breaks the rules hurts nobody but itself.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "transport/delivery/inbox.hpp"
#include "transport/delivery/outbox.hpp"

using namespace warren;
using namespace warren::mesh;
using namespace std::chrono_literals;

namespace {

constexpr MeshTime kNow{1s};
constexpr auto kMessage = ParcelClass::kMessage;

struct HostileFixture {
  DeliveryConfig config;
  ParcelBudget budget{64'000'000};
  Inbox inbox{config, budget};

  std::optional<ParcelInbox::Arrived> take(const ParcelFrame& frame) {
    auto received = inbox.on_frame(frame);
    if (!received) return std::nullopt;
    return std::get<ParcelInbox::Arrived>(std::move(*received));
  }
  std::uint64_t malformed() const { return inbox.counts().fragments_malformed; }
};

ParcelFrame fragment(std::uint32_t number, std::uint32_t total, std::uint32_t offset,
                     std::size_t size, std::uint8_t value = 1) {
  return {{1, number}, kMessage, 0, total, offset, std::vector<std::uint8_t>(size, value)};
}

}  // namespace

TEST_CASE_FIXTURE(HostileFixture, "fragments beyond their total are refused") {
  CHECK_FALSE(take(fragment(0, 10, 5, 6)));
  CHECK_FALSE(take(fragment(0, 10, 11, 0)));
  CHECK_FALSE(take(fragment(0, 10, 0xFFFF'FFFF, 5)));
  CHECK_FALSE(take(fragment(0, 1'000'001, 0, 5)));
  CHECK_FALSE(take(fragment(0, 0xFFFF'FFFF, 0, 5)));
  CHECK(malformed() == 5);
  CHECK(inbox.unfinished_bytes() == 0);
}

TEST_CASE_FIXTURE(HostileFixture, "a fragment that changes total or class is refused") {
  CHECK_FALSE(take(fragment(0, 10, 0, 5)));
  CHECK_FALSE(take(fragment(0, 11, 5, 6)));
  auto other_class = fragment(0, 10, 5, 5);
  other_class.priority = ParcelClass::kControl;
  CHECK_FALSE(take(other_class));
  CHECK(malformed() == 2);
  CHECK(take(fragment(0, 10, 5, 5)));
}

TEST_CASE_FIXTURE(HostileFixture, "overlapping fragments make one parcel of its size") {
  CHECK_FALSE(take(fragment(0, 10, 2, 5, 1)));
  CHECK_FALSE(take(fragment(0, 10, 0, 5, 2)));
  CHECK_FALSE(take(fragment(0, 10, 3, 3, 3)));
  const auto parcel = take(fragment(0, 10, 6, 4, 4));
  REQUIRE(parcel);
  CHECK(parcel->bytes.size() == 10);
  CHECK(inbox.counts().fragments_duplicate == 1);
}

TEST_CASE_FIXTURE(HostileFixture, "many parcels begun take no more memory than the limit") {
  for (std::uint32_t number = 0; number < 100; ++number)
    CHECK_FALSE(take(fragment(number, 1'000'000, 0, 1)));
  CHECK(inbox.unfinished_bytes() <= config.parcel.received_bytes_max);
  CHECK(budget.used() == inbox.unfinished_bytes());
  CHECK(inbox.counts().fragments_refused == 98);
  // Control has room that messages cannot take.
  auto control = fragment(200, 1'000'000, 0, 1);
  control.priority = ParcelClass::kControl;
  (void)take(control);
  CHECK(inbox.counts().fragments_refused == 98);
  for (std::uint32_t number = 1000; number < 9000; ++number)
    CHECK_FALSE(take(fragment(number, 2, 0, 1)));
  CHECK(inbox.unfinished_bytes() <= config.parcel.received_bytes_max);
}

TEST_CASE_FIXTURE(HostileFixture, "an earlier parcel gets room from a later one") {
  for (std::uint32_t number = 10; number < 13; ++number)
    (void)take(fragment(number, 900'000, 0, 1));
  (void)take(fragment(1, 1'000'000, 0, 1));
  CHECK(inbox.counts().parcels_evicted == 1);
  CHECK(inbox.counts().fragments_refused == 0);
}

TEST_CASE_FIXTURE(HostileFixture, "a parcel in too many pieces is bounded, and ends nevertheless") {
  for (std::uint32_t offset = 0; offset < 10'000; offset += 2)
    (void)take(fragment(0, 10'000, offset, 1));
  CHECK(inbox.counts().fragments_refused == 5000 - ParcelInbox::kRangesPerParcelMax);
  CHECK(take(fragment(0, 10'000, 0, 10'000)));
}

TEST_CASE_FIXTURE(HostileFixture,
                  "the pieces of many parcels are charged, bounded and given back") {
  for (std::uint32_t number = 0; number < 500; ++number) {
    for (std::uint32_t offset = 0; offset < 2'000; offset += 2)
      (void)take(fragment(number, 2'000, offset, 1));
  }
  const std::size_t flat = 500 * ParcelBudget::charge(2'000);
  CHECK(inbox.unfinished_bytes() > flat + 200'000);
  CHECK(inbox.unfinished_bytes() <= flat + ParcelInbox::kRangeBytesMax);
  CHECK(budget.used() == inbox.unfinished_bytes());
  CHECK(take(fragment(499, 2'000, 0, 2'000)));
  CHECK(take(fragment(0, 2'000, 0, 2'000)));
  CHECK(budget.used() == inbox.unfinished_bytes());
  for (std::uint32_t number = 0; number < 500; ++number) {
    (void)take(fragment(number, 2'000, 0, 2'000));
    inbox.finish_parcel({1, number});
  }
  CHECK(inbox.unfinished_bytes() == 0);
  CHECK(budget.used() == 0);
}

TEST_CASE_FIXTURE(HostileFixture, "a huge finished_before ends the sender's own stream only") {
  CHECK_FALSE(take(fragment(0, 10, 0, 5)));
  auto frame = fragment(0xFFFF'FFFF, 10, 0, 5);
  frame.finished_before = 0xFFFF'FFFF;
  CHECK_FALSE(take(frame));
  CHECK(inbox.counts().parcels_forgotten == 1);
  CHECK(take(fragment(0xFFFF'FFFF, 10, 5, 5)));
  inbox.finish_parcel({1, 0xFFFF'FFFF});
  CHECK_FALSE(take(fragment(7, 10, 0, 10)));
  CHECK(inbox.counts().fragments_finished == 1);
  frame.finished_before = 0;
  frame.parcel.number = 0;
  frame.finished_before = 1;  // before itself
  CHECK_FALSE(take(frame));
  CHECK(malformed() == 1);
}

TEST_CASE_FIXTURE(HostileFixture, "questions about everything are answered up to a bound") {
  for (std::uint32_t number = 0; number < 5000; ++number)
    CHECK_FALSE(take(fragment(number, 10, 10, 0)));
  CHECK(inbox.counts().answers_dropped == 5000 - 1024);
  int answers = 0;
  while (inbox.next_answer(1200)) ++answers;
  CHECK(answers == 1024);
}

TEST_CASE_FIXTURE(HostileFixture, "finished numbers full of gaps are bounded") {
  for (std::uint32_t number = 0; number < 20'000; number += 2) {
    if (take(fragment(number, 1, 0, 1))) inbox.finish_parcel({1, number});
  }
  const auto saved = inbox.save();
  CHECK(saved.stream->finished.size() <= SavedIncoming::kRangesMax);
  CHECK(saved.stream->finished.size() > 3000);
  CHECK(inbox.counts().fragments_refused > 5000);
}

TEST_CASE_FIXTURE(HostileFixture, "late fragments of a stream that was given up change nothing") {
  CHECK_FALSE(take(fragment(0, 10, 0, 5)));
  auto next_stream = fragment(0, 10, 0, 10);
  next_stream.parcel.stream = 2;
  CHECK(take(next_stream));
  CHECK_FALSE(take(fragment(0, 10, 5, 5)));
  CHECK(inbox.counts().old_stream == 1);
  CHECK(inbox.save().stream->id == 2);
}

TEST_CASE("states that are not about our parcels, or beyond their end, change nothing") {
  TelemetryBoard board;
  ParcelBudget budget(1'000'000);
  Outbox outbox(DeliveryConfig{}, 9, board, budget);
  const auto key = outbox.send_parcel(kMessage, std::vector<std::uint8_t>(100));
  CHECK_FALSE(outbox.on_state(kNow, {{8, key->number}, true, {}}));
  CHECK_FALSE(outbox.on_state(kNow, {{9, 5}, true, {}}));
  CHECK(outbox.counts().states_unknown == 2);
  CHECK_FALSE(outbox.on_state(kNow, {*key, false, {{0, 101}}}));
  CHECK(outbox.counts().states_malformed == 1);
  CHECK(outbox.next(kNow, {1200, 1200}, SendClass::kMessageParcel, 0ms));
}

TEST_CASE("random parcel frames never exceed the bounds") {
  CHECK(rc::check("random parcel frames", [] {
    DeliveryConfig config;
    config.parcel.received_bytes_max = 1'300'000;
    config.parcel.unfinished_max = 10;
    ParcelBudget budget(1'200'000);
    {
      Inbox inbox(config, budget);
      const auto few = rc::gen::element<std::uint32_t>(0, 1, 2, 3, 100'000, 0xFFFF'FFFF);
      const int frames = *rc::gen::inRange(0, 200);
      for (int i = 0; i < frames; ++i) {
        ParcelFrame frame;
        frame.parcel = {*rc::gen::inRange<std::uint64_t>(0, 3), *few};
        frame.priority = *rc::gen::arbitrary<bool>() ? kMessage : ParcelClass::kControl;
        frame.finished_before = *few;
        frame.total = *few;
        frame.offset = *few;
        frame.bytes.resize(*rc::gen::inRange<std::size_t>(0, 4));
        const auto received = inbox.on_frame(frame);
        RC_ASSERT(inbox.unfinished_bytes() <= config.parcel.received_bytes_max);
        RC_ASSERT(budget.used() == inbox.unfinished_bytes());
        if (received && *rc::gen::arbitrary<bool>())
          inbox.finish_parcel(std::get<ParcelInbox::Arrived>(*received).key);
        if (i % 20 == 0) (void)inbox.next_answer(100);
      }
    }
    RC_ASSERT(budget.used() == 0U);
  }));
}
