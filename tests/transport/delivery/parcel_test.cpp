// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "transport/delivery/parcel_inbox.hpp"
#include "transport/delivery/parcel_outbox.hpp"

using namespace warren;
using namespace warren::mesh;
using namespace std::chrono_literals;

namespace {

constexpr MeshTime kNow{1s};
constexpr std::uint64_t kStream = 77;

std::vector<std::uint8_t> bytes_of(std::size_t size) { return std::vector<std::uint8_t>(size, 3); }

struct ParcelFixture {
  ParcelConfig config;
  OutboxCounts out_counts;
  InboxCounts in_counts;
  ParcelBudget sent{64'000'000};
  ParcelBudget received{64'000'000};
  ParcelOutbox outbox{config, kStream, sent, out_counts};
  ParcelInbox inbox{config, received, in_counts};

  std::optional<OutgoingFrame> next(std::size_t room = 1200) {
    auto frame = outbox.next(room, ParcelClass::kControl);
    return frame ? std::move(frame) : outbox.next(room, ParcelClass::kMessage);
  }
  // One frame over the link and acknowledged.
  std::optional<ParcelInbox::Arrived> pass(const OutgoingFrame& frame) {
    outbox.on_acked(kNow, std::get<FragmentTicket>(frame.ticket));
    return inbox.on_fragment(std::get<ParcelFrame>(frame.frame));
  }
  std::vector<ParcelInbox::Arrived> pass_all() {
    std::vector<ParcelInbox::Arrived> arrived;
    while (const auto frame = next()) {
      auto parcel = pass(*frame);
      if (parcel) arrived.push_back(std::move(*parcel));
    }
    return arrived;
  }
  std::optional<ParcelKey> pass_answer() {
    const auto answer = inbox.next_answer(1200);
    REQUIRE(answer);
    return outbox.on_state(kNow, std::get<ParcelStateFrame>(answer->frame));
  }
};

ParcelFrame fragment_of(const OutgoingFrame& frame) { return std::get<ParcelFrame>(frame.frame); }

}  // namespace

TEST_CASE_FIXTURE(ParcelFixture, "a parcel is kept until it is handed over, and told once") {
  const auto key = outbox.send(ParcelClass::kMessage, bytes_of(3000));
  const auto arrived = pass_all();
  REQUIRE(arrived.size() == 1);
  CHECK(arrived[0].key == *key);
  CHECK(arrived[0].bytes == bytes_of(3000));
  CHECK(outbox.unfinished() == 1);
  CHECK_FALSE(inbox.answers_due());
  inbox.finish(*key);
  CHECK(received.used() == 0);
  CHECK(pass_answer() == *key);
  CHECK(outbox.unfinished() == 0);
  CHECK(sent.used() == 0);
  inbox.finish(*key);
  CHECK_FALSE(inbox.answers_due());
}

TEST_CASE_FIXTURE(ParcelFixture, "an empty parcel comes too") {
  const auto key = outbox.send(ParcelClass::kControl, {});
  CHECK_FALSE(next());
  const auto question = outbox.next_question(kNow, 1200);
  REQUIRE(question);
  const auto arrived = pass(*question);
  REQUIRE(arrived);
  CHECK(arrived->bytes.empty());
  CHECK_FALSE(pass_answer());
  CHECK_FALSE(pass(*question));
  inbox.finish(*key);
  CHECK(pass_answer() == *key);
}

TEST_CASE_FIXTURE(ParcelFixture, "the largest parcel is taken, a larger one refused") {
  CHECK(outbox.send(ParcelClass::kMessage, bytes_of(1'000'000)));
  CHECK(outbox.send(ParcelClass::kMessage, bytes_of(1'000'001)).error() ==
        ParcelRefusal::kTooLarge);
  CHECK(pass_all().size() == 1);
}

TEST_CASE_FIXTURE(ParcelFixture,
                  "an outbox is full by number, by bytes, and by the node's budget") {
  for (int i = 0; i < 1024; ++i) REQUIRE(outbox.send(ParcelClass::kMessage, bytes_of(1)));
  CHECK(outbox.send(ParcelClass::kMessage, bytes_of(1)).error() == ParcelRefusal::kFull);
  ParcelOutbox second(config, kStream, sent, out_counts);
  for (int i = 0; i < 15; ++i) REQUIRE(second.send(ParcelClass::kMessage, bytes_of(1'000'000)));
  CHECK(second.send(ParcelClass::kMessage, bytes_of(1'000'000)).error() == ParcelRefusal::kFull);
  ParcelBudget small(1000);
  ParcelOutbox third(config, kStream, small, out_counts);
  CHECK(third.send(ParcelClass::kMessage, bytes_of(1000)).error() == ParcelRefusal::kFull);
  CHECK(third.send(ParcelClass::kMessage, bytes_of(100)));
  CHECK(out_counts.parcels_refused == 3);
}

TEST_CASE_FIXTURE(ParcelFixture, "what was lost goes again and nothing else") {
  (void)outbox.send(ParcelClass::kMessage, bytes_of(5000));
  std::vector<OutgoingFrame> frames;
  while (auto frame = next()) frames.push_back(std::move(*frame));
  REQUIRE(frames.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    if (i != 2) CHECK_FALSE(pass(frames[i]));
  }
  outbox.on_lost(kNow, std::get<FragmentTicket>(frames[1].ticket));  // acknowledged before
  outbox.on_lost(kNow, std::get<FragmentTicket>(frames[2].ticket));
  const auto again = next();
  REQUIRE(again);
  CHECK(fragment_of(*again).offset == fragment_of(frames[2]).offset);
  CHECK(pass(*again));
  CHECK_FALSE(next());
}

TEST_CASE_FIXTURE(ParcelFixture, "fragments fit into whatever room there is") {
  (void)outbox.send(ParcelClass::kMessage, bytes_of(2000));
  CHECK_FALSE(next(60));
  for (const std::size_t room : {128UL, 300UL, 1000UL, 90'000UL}) {
    const auto frame = next(room);
    REQUIRE(frame);
    CHECK(encoded_bytes(frame->frame) <= room);
  }
  CHECK_FALSE(next());
}

TEST_CASE_FIXTURE(ParcelFixture,
                  "a short parcel is not held up by a long one, nor a long one by "
                  "short ones") {
  const auto first = outbox.send(ParcelClass::kMessage, bytes_of(500'000));
  for (int i = 0; i < 100; ++i) (void)outbox.send(ParcelClass::kMessage, bytes_of(100));
  int of_long = 0;
  for (int i = 0; i < 100; ++i) {
    const auto frame = next();
    REQUIRE(frame);
    of_long += fragment_of(*frame).parcel == *first ? 1 : 0;
  }
  CHECK(of_long == 50);
}

TEST_CASE_FIXTURE(ParcelFixture, "control goes before messages") {
  (void)outbox.send(ParcelClass::kMessage, bytes_of(10));
  (void)outbox.send(ParcelClass::kControl, bytes_of(10));
  CHECK(fragment_of(*next()).priority == ParcelClass::kControl);
  CHECK(outbox.has_fragment(ParcelClass::kMessage));
  CHECK_FALSE(outbox.has_fragment(ParcelClass::kControl));
}

TEST_CASE_FIXTURE(ParcelFixture, "without a receipt the sender asks, now and then") {
  const auto key = outbox.send(ParcelClass::kMessage, bytes_of(10));
  CHECK(outbox.question_due() == kNever);
  (void)pass_all();
  CHECK(outbox.question_due() == kNow + 2s);
  CHECK_FALSE(outbox.next_question(kNow + 1999ms, 1200));
  const auto question = outbox.next_question(kNow + 2s, 1200);
  REQUIRE(question);
  CHECK(fragment_of(*question).bytes.empty());
  CHECK(outbox.question_due() == kNow + 4s);
  (void)pass(*question);
  CHECK_FALSE(pass_answer());  // it has all, and has not handed it over
  CHECK_FALSE(next());
  outbox.on_lost(kNow, std::get<FragmentTicket>(question->ticket));
  CHECK_FALSE(next());
  inbox.finish(*key);
  CHECK(pass_answer() == *key);
  CHECK(outbox.question_due() == kNever);
}

TEST_CASE_FIXTURE(ParcelFixture,
                  "a receipt that was lost comes again; so does the answer to a "
                  "fragment of a finished parcel") {
  const auto key = outbox.send(ParcelClass::kMessage, bytes_of(10));
  const auto frame = next();
  (void)pass(*frame);
  inbox.finish(*key);
  const auto lost = inbox.next_answer(1200);
  inbox.on_lost(std::get<ParcelStateTicket>(lost->ticket));
  CHECK(inbox.next_answer(1200));
  CHECK_FALSE(inbox.answers_due());
  CHECK_FALSE(inbox.on_fragment(fragment_of(*frame)));
  CHECK(in_counts.fragments_finished == 1);
  CHECK(pass_answer() == *key);
}

TEST_CASE_FIXTURE(ParcelFixture,
                  "what the receiver has dropped is sent again, by one fragment "
                  "first, and in full as soon as that one is kept") {
  (void)outbox.send(ParcelClass::kMessage, bytes_of(5000));
  for (int i = 0; i < 5; ++i) (void)pass(*next());
  inbox.drop_partial();  // nothing: it is handed on
  CHECK(in_counts.parcels_evicted == 0);
  ParcelInbox other(config, received, in_counts);
  const auto ask = [&](MeshTime when) {
    const auto question = outbox.next_question(when, 1200);
    REQUIRE(question);
    (void)other.on_fragment(fragment_of(*question));
    const auto answer = other.next_answer(1200);
    REQUIRE(answer);
    (void)outbox.on_state(when, std::get<ParcelStateFrame>(answer->frame));
  };
  ask(kNow + 2s);
  const auto probe = next();
  REQUIRE(probe);
  CHECK_FALSE(next());
  outbox.on_acked(kNow + 3s, std::get<FragmentTicket>(probe->ticket));
  ask(kNow + 5s);  // not kept
  const auto second_probe = next();
  REQUIRE(second_probe);
  CHECK_FALSE(next());
  CHECK_FALSE(other.on_fragment(fragment_of(*second_probe)));
  outbox.on_acked(kNow + 6s, std::get<FragmentTicket>(second_probe->ticket));
  ask(kNow + 8s);  // kept
  int rest = 0;
  std::optional<ParcelInbox::Arrived> arrived;
  while (const auto frame = next()) {
    ++rest;
    arrived = other.on_fragment(fragment_of(*frame));
  }
  CHECK(rest == 4);
  CHECK(arrived);
}

TEST_CASE_FIXTURE(ParcelFixture, "a restored outbox sends again, and uses no number twice") {
  const auto key = outbox.send(ParcelClass::kControl, bytes_of(10));
  const SavedOutgoing saved = outbox.save();
  const auto unsaved = outbox.send(ParcelClass::kMessage, bytes_of(10));
  ParcelBudget budget(1000);
  ParcelOutbox restored(config, kStream + 1, budget, out_counts);
  restored.restore(saved);
  CHECK(budget.used() == ParcelBudget::charge(10));
  const auto frame = restored.next(1200, ParcelClass::kControl);
  REQUIRE(frame);
  CHECK(fragment_of(*frame).parcel == *key);
  const auto next_key = restored.send(ParcelClass::kMessage, bytes_of(10));
  CHECK(next_key->stream == kStream);
  CHECK(next_key->number > unsaved->number);
  CHECK(next_key->number == 1 + ParcelOutbox::kNumbersPerSave);
}

TEST_CASE_FIXTURE(ParcelFixture, "when the numbers end, a new stream begins once all is finished") {
  outbox.restore({kStream, 0xFFFF'FFF0, {{5, ParcelClass::kMessage, bytes_of(4)}}});
  CHECK(outbox.send(ParcelClass::kMessage, bytes_of(1)).error() == ParcelRefusal::kFull);
  CHECK(outbox.on_state(kNow, {{kStream, 5}, true, {}}));
  const auto key = outbox.send(ParcelClass::kMessage, bytes_of(1));
  REQUIRE(key);
  CHECK(key->stream != kStream);
  CHECK(key->number == 0);
}

TEST_CASE_FIXTURE(ParcelFixture,
                  "what was handed on and not finished comes again after a restart, "
                  "what was finished does not") {
  const auto first = outbox.send(ParcelClass::kMessage, bytes_of(10));
  const auto second = outbox.send(ParcelClass::kMessage, bytes_of(11));
  CHECK(pass_all().size() == 2);
  inbox.finish(*first);
  ParcelInbox restored(config, received, in_counts);
  restored.restore(inbox.save());
  outbox.on_peer_restarted();
  std::vector<ParcelKey> arrived;
  while (const auto frame = next()) {
    const auto parcel = restored.on_fragment(fragment_of(*frame));
    if (parcel) arrived.push_back(parcel->key);
  }
  CHECK(arrived == std::vector<ParcelKey>{*second});
  // The layer above may say later that it had stored it before.
  ParcelInbox told(config, received, in_counts);
  told.restore(inbox.save());
  told.finish(*second);
  CHECK(told.answers_due());
}

TEST_CASE_FIXTURE(ParcelFixture, "the receiver tells a new life of the sender what it has") {
  (void)outbox.send(ParcelClass::kMessage, bytes_of(5000));
  (void)pass(*next());
  ParcelBudget budget(10'000);
  ParcelOutbox restored(config, 1, budget, out_counts);
  restored.restore(outbox.save());
  inbox.on_peer_restarted();
  const auto answer = inbox.next_answer(1200);
  REQUIRE(answer);
  (void)restored.on_state(kNow, std::get<ParcelStateFrame>(answer->frame));
  CHECK(fragment_of(*restored.next(1200, ParcelClass::kMessage)).offset > 1000);
}
