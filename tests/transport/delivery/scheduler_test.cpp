// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/scheduler.hpp"

#include <numeric>

#include <doctest/doctest.h>

using namespace warren;
using namespace warren::mesh;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kRoom = 1200;
constexpr std::size_t kOverhead = 60;
constexpr double kRate = 125'000.0;

// A saturated sender: fills packet after packet as a pacer of kRate would ask for them.
struct SchedulerFixture {
  TelemetryBoard board;
  ParcelBudget sent_budget{64'000'000};
  ParcelBudget received_budget{64'000'000};
  Outbox outbox{DeliveryConfig{}, 1, board, sent_budget};
  Inbox inbox{DeliveryConfig{}, received_budget};
  Scheduler scheduler;
  bool fresh = false;
  bool backlog = false;
  std::size_t pulls = 0;
  MeshTime now{1s};
  std::array<double, kSendClasses> sent{};
  double link_bytes = 0.0;
  std::vector<FilledPacket> packets;

  FilledPacket fill(std::size_t before = 0) {
    const PullMap pull = [&](MapClass wanted, std::size_t limit) -> std::optional<PulledMap> {
      ++pulls;
      if (!(wanted == MapClass::kFresh ? fresh : backlog)) return std::nullopt;
      return PulledMap{1, std::vector<std::uint8_t>(limit)};
    };
    FilledPacket packet;
    if (before > 0) packet.add(PingFrame{static_cast<std::uint16_t>(before)}, SendClass::kControl);
    scheduler.fill(state(), kRoom, outbox, inbox, pull, packet);
    CHECK(packet.bytes <= kRoom);
    return packet;
  }
  SendState state() const { return {now, kRate, 100ms, kOverhead, kRoom}; }
  void set(std::uint16_t key, std::size_t bytes) {
    REQUIRE(board.set(key, std::vector<std::uint8_t>(bytes)));
    outbox.on_telemetry_set(key);
  }
  // All is acknowledged at once.
  void run(int count, std::size_t parcel_bytes = 0) {
    for (int i = 0; i < count; ++i) {
      if (parcel_bytes > 0 && outbox.unfinished_bytes() < 2'000'000)
        (void)outbox.send_parcel(ParcelClass::kMessage, std::vector<std::uint8_t>(parcel_bytes));
      FilledPacket packet = fill();
      const double bytes = static_cast<double>(packet.bytes + kOverhead);
      for (std::size_t c = 0; c < kSendClasses; ++c)
        sent[c] += static_cast<double>(packet.class_bytes[c]);
      for (const Frame& frame : packet.frames) finish(frame);
      packets.push_back(std::move(packet));
      link_bytes += bytes;
      now += Duration(static_cast<Duration::rep>(bytes / kRate * 1e6));
    }
  }
  void finish(const Frame& frame) {
    const auto* fragment = std::get_if<ParcelFrame>(&frame);
    if (fragment == nullptr || fragment->offset + fragment->bytes.size() < fragment->total) return;
    outbox.on_state(now, ParcelStateFrame{fragment->parcel, true, {}});
  }
  // Of all bytes on the link.
  double link_share(SendClass send_class) const {
    return sent[static_cast<std::size_t>(send_class)] / link_bytes;
  }
  double share(SendClass send_class) const {
    return sent[static_cast<std::size_t>(send_class)] /
           std::accumulate(sent.begin(), sent.end(), 0.0);
  }
};

void set_all(SchedulerFixture& f, int keys) {
  for (int key = 0; key < keys; ++key) {
    f.board.set(static_cast<std::uint16_t>(key), std::vector<std::uint8_t>(500));
    f.outbox.on_telemetry_set(static_cast<std::uint16_t>(key));
  }
}

}  // namespace

TEST_CASE_FIXTURE(SchedulerFixture, "fresh goes before backlog, which has its tenth") {
  fresh = backlog = true;
  run(1000);
  CHECK(share(SendClass::kBacklog) == doctest::Approx(0.10).epsilon(0.1));
  CHECK(share(SendClass::kFresh) == doctest::Approx(0.90).epsilon(0.1));
}

TEST_CASE_FIXTURE(SchedulerFixture, "parcels starve neither fresh nor backlog") {
  fresh = backlog = true;
  run(1000, 900'000);
  CHECK(share(SendClass::kFresh) == doctest::Approx(0.20).epsilon(0.1));
  CHECK(share(SendClass::kBacklog) == doctest::Approx(0.10).epsilon(0.1));
  CHECK(share(SendClass::kMessageParcel) == doctest::Approx(0.70).epsilon(0.1));
}

TEST_CASE_FIXTURE(SchedulerFixture, "what is not used goes to the next") {
  backlog = true;
  run(300);
  CHECK(share(SendClass::kBacklog) == 1.0);
  run(300, 900'000);
  backlog = false;
  scheduler.wake();
  sent = {};
  run(300, 900'000);
  CHECK(share(SendClass::kMessageParcel) == 1.0);
}

TEST_CASE_FIXTURE(SchedulerFixture,
                  "telemetry has its fifth of the link at most, whatever it is "
                  "next to, and all it needs below that") {
  fresh = true;
  for (int i = 0; i < 1000; ++i) {
    set_all(*this, 20);
    run(1);
  }
  CHECK(link_share(SendClass::kTelemetry) < 0.205);
  CHECK(link_share(SendClass::kTelemetry) > 0.19);
  fresh = false;
  packets.clear();
  const MeshTime start = now;
  double bytes = 0.0;
  while (now < start + 10s) {
    set_all(*this, 20);
    const FilledPacket packet = fill();
    if (!packet.frames.empty()) bytes += static_cast<double>(packet.bytes + kOverhead);
    now += 5ms;
  }
  CHECK(bytes / 10.0 < 0.21 * kRate);
  CHECK(bytes / 10.0 > 0.17 * kRate);
}

TEST_CASE_FIXTURE(SchedulerFixture,
                  "a value larger than the packets of now has one of its own, in its turn") {
  fresh = true;
  set(1, 700);
  set(2, 20);
  SendState slow = state();
  slow.room_max = kRoom;
  const PullMap pull = [](MapClass wanted, std::size_t limit) -> std::optional<PulledMap> {
    return PulledMap{1, std::vector<std::uint8_t>(wanted == MapClass::kFresh ? limit : 1)};
  };
  const auto fill_slow = [&] {
    FilledPacket packet;
    packet.add(PingFrame{10}, SendClass::kControl);
    scheduler.fill(slow, 340, outbox, inbox, pull, packet);
    return packet;
  };
  const FilledPacket large = fill_slow();
  REQUIRE(large.frames.size() == 2);
  CHECK(std::get<TelemetryFrame>(large.frames[1]).key == 1);
  CHECK(large.bytes > 700);
  // Small ones that are always new do not keep it from its turn.
  set(1, 700);
  int large_values = 0;
  for (int i = 0; i < 10; ++i) {
    set(2, 20);
    slow.now += 100ms;
    for (const Frame& frame : fill_slow().frames) {
      const auto* value = std::get_if<TelemetryFrame>(&frame);
      if (value != nullptr && value->key == 1) ++large_values;
    }
  }
  CHECK(large_values == 1);
  set(3, 700);
  slow.room_max = 500;
  slow.now += 1s;
  CHECK(fill_slow().bytes <= 340);
  CHECK(outbox.counts().telemetry_oversized == 1);
}

TEST_CASE_FIXTURE(SchedulerFixture, "answers and questions have their tenth at most") {
  for (int i = 0; i < 2000; ++i) {
    for (std::uint32_t number = 0; number < 100; ++number)
      (void)inbox.on_frame(ParcelFrame{{5, number}, ParcelClass::kMessage, 0, 10, 10, {}});
    run(1, 900'000);
  }
  CHECK(link_share(SendClass::kControl) < 0.102);
  CHECK(link_share(SendClass::kControl) > 0.09);
}

TEST_CASE_FIXTURE(SchedulerFixture, "many acknowledgements do not keep receipts from going") {
  for (int i = 0; i < 500; ++i) {
    (void)fill(300);
    now += 1ms;
  }
  (void)inbox.on_frame(ParcelFrame{{5, 0}, ParcelClass::kMessage, 0, 10, 10, {}});
  CHECK(fill(300).frames.size() == 2);
}

TEST_CASE_FIXTURE(SchedulerFixture,
                  "a packet takes urgent, answers, telemetry, parcels, then one "
                  "map packet that goes last") {
  fresh = true;
  outbox.send_urgent(now, std::vector<std::uint8_t>(64));
  set_all(*this, 1);
  (void)inbox.on_frame(ParcelFrame{{5, 0}, ParcelClass::kMessage, 0, 10, 10, {}});
  (void)outbox.send_parcel(ParcelClass::kMessage, std::vector<std::uint8_t>(30));
  (void)outbox.send_parcel(ParcelClass::kControl, std::vector<std::uint8_t>(20));
  const FilledPacket packet = fill(100);
  REQUIRE(packet.frames.size() == 6);  // no map: less than 512 bytes are left
  CHECK(std::holds_alternative<PingFrame>(packet.frames[0]));
  CHECK(std::holds_alternative<UrgentFrame>(packet.frames[1]));
  CHECK(std::holds_alternative<ParcelStateFrame>(packet.frames[2]));
  CHECK(std::holds_alternative<TelemetryFrame>(packet.frames[3]));
  CHECK(std::get<ParcelFrame>(packet.frames[4]).priority == ParcelClass::kControl);
  CHECK(std::get<ParcelFrame>(packet.frames[5]).priority == ParcelClass::kMessage);
  CHECK(packet.tickets.size() == 5);
  const FilledPacket next = fill(5);
  REQUIRE(next.frames.size() == 2);
  CHECK(std::get<MapFrame>(next.frames[1]).bytes.size() + 1 + 7 == kRoom);
  CHECK(next.bytes == kRoom);
}

TEST_CASE_FIXTURE(SchedulerFixture, "a source that had nothing is asked again after a wake") {
  CHECK(scheduler.next_due(state(), outbox, inbox) == MeshTime::min());
  CHECK(fill().frames.empty());
  CHECK(pulls == 2);
  CHECK(scheduler.next_due(state(), outbox, inbox) == kNever);
  fresh = true;
  CHECK(fill().frames.empty());
  scheduler.wake();
  CHECK(fill().frames.size() == 1);
}

TEST_CASE_FIXTURE(SchedulerFixture, "when it fills nothing, it is due later, and then fills") {
  set_all(*this, 20);
  int packets_filled = 0;
  for (int i = 0; i < 200; ++i) {
    if (!fill().frames.empty()) {
      ++packets_filled;
      continue;
    }
    const MeshTime due = scheduler.next_due(state(), outbox, inbox);
    if (due == kNever) break;
    REQUIRE(due > now);
    now = due;
    const FilledPacket packet = fill();
    REQUIRE(!packet.frames.empty());
    ++packets_filled;
  }
  CHECK(packets_filled >= 10);
  CHECK(outbox.next_due(SendClass::kTelemetry) == kNever);
}

TEST_CASE_FIXTURE(SchedulerFixture, "new urgent bytes go in the very next packet") {
  fresh = backlog = true;
  run(50, 900'000);
  outbox.send_urgent(now, std::vector<std::uint8_t>{1});
  const FilledPacket packet = fill();
  CHECK(std::holds_alternative<UrgentFrame>(packet.frames.front()));
  FilledPacket urgent_only;
  outbox.send_urgent(now, std::vector<std::uint8_t>{2});
  scheduler.fill_urgent(state(), kRoom, outbox, urgent_only);
  CHECK(urgent_only.frames.size() == 1);
  CHECK(urgent_only.bytes < 20);
}
