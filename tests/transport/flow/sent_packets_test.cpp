// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/sent_packets.hpp"

#include <vector>

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

MeshTime at(int ms) { return MeshTime{milliseconds{ms}}; }

void send(SentPackets& sent, std::uint64_t number, MeshTime now) {
  sent.on_sent(number, {.sent = now,
                        .ip_bytes = 1000,
                        .own = milliseconds{10},
                        .busy = true,
                        .wants_ack = true,
                        .tickets = {MapTicket{number, MapClass::kFresh}}});
}

AckFrame ack(std::vector<NumberRange> ranges) {
  AckFrame frame;
  frame.ranges = std::move(ranges);
  return frame;
}

std::vector<std::uint64_t> numbers(const std::vector<Ticket>& tickets) {
  std::vector<std::uint64_t> result;
  for (const Ticket& ticket : tickets) result.push_back(std::get<MapTicket>(ticket).number);
  return result;
}

TEST_CASE("a packet is lost when the third after it arrived") {
  SentPackets sent;
  for (int i = 0; i < 6; ++i) send(sent, 100 + static_cast<std::uint64_t>(i), at(10 * i));
  auto settled = sent.on_ack(at(100), ack({{102, 103}, {100, 101}}));
  CHECK(numbers(settled.acked) == std::vector<std::uint64_t>{100, 102});
  CHECK(settled.lost.empty());
  settled = sent.on_ack(at(110), ack({{104, 105}, {100, 101}}));
  CHECK(numbers(settled.lost) == std::vector<std::uint64_t>{101});
  CHECK(sent.packets_in_flight() == 2);
  CHECK(sent.bytes_in_flight() == 2000);
}

TEST_CASE("a packet held lost that comes late is told as acknowledged, and makes it patient") {
  SentPackets sent;
  for (int i = 0; i < 5; ++i) send(sent, static_cast<std::uint64_t>(i), at(10 * i));
  auto settled = sent.on_ack(at(100), ack({{1, 5}}));
  CHECK(numbers(settled.lost) == std::vector<std::uint64_t>{0});
  settled = sent.on_ack(at(160), ack({{0, 5}}));
  CHECK(numbers(settled.acked) == std::vector<std::uint64_t>{0});
  for (int i = 5; i < 10; ++i) send(sent, static_cast<std::uint64_t>(i), at(150 + 10 * i));
  settled = sent.on_ack(at(300), ack({{6, 10}, {0, 5}}));
  CHECK(settled.lost.empty());
}

TEST_CASE("the round trip of a crowded cell is measured, though all packets are held lost before") {
  SentPackets sent;
  for (std::uint64_t i = 0; i < 12; ++i) {
    send(sent, i, at(static_cast<int>(i) * 750));
    CHECK(numbers(sent.on_time(sent.loss_time()).lost) == std::vector<std::uint64_t>{i});
  }
  const auto settled = sent.on_ack(at(9000), ack({{0, 1}}));
  CHECK(numbers(settled.acked) == std::vector<std::uint64_t>{0});
  REQUIRE(sent.smoothed_rtt());
  CHECK(*sent.smoothed_rtt() == seconds{5});  // no longer is waited for
  send(sent, 12, at(9000));
  CHECK(sent.loss_time() >= at(9000) + milliseconds{1500});
}

TEST_CASE("the last packet is lost by time, without any back-off") {
  SentPackets sent;
  send(sent, 0, at(0));
  sent.on_ack(at(100), ack({{0, 1}}));
  for (std::uint64_t i = 1; i < 6; ++i) {
    const MeshTime now = at(static_cast<int>(i) * 1000);
    send(sent, i, now);
    const MeshTime lost_at = sent.loss_time();
    CHECK(lost_at - now >= milliseconds{150});
    CHECK(lost_at - now <= milliseconds{600});
    CHECK(sent.on_time(lost_at - Duration{1}).lost.empty());
    CHECK(numbers(sent.on_time(lost_at).lost) == std::vector<std::uint64_t>{i});
    CHECK(sent.loss_time() == kNever);
  }
}

TEST_CASE(
    "while nothing more is sent one packet in a round trip is held lost, whatever was learned") {
  SentPackets sent;
  send(sent, 0, at(0));
  sent.on_ack(at(100), ack({{0, 1}}));
  // An acknowledgement that stayed away for long made it patient.
  send(sent, 1, at(1000));
  CHECK(sent.on_time(at(1600)).lost.size() == 1);
  AckFrame late = ack({{0, 2}});
  late.delay = milliseconds{1400};
  sent.on_ack(at(2500), late);
  for (std::uint64_t i = 2; i < 5; ++i) send(sent, i, at(3000));
  CHECK(sent.loss_time() <= at(3600));
  CHECK(numbers(sent.on_time(at(3600)).lost) == std::vector<std::uint64_t>{2});
  CHECK(sent.on_time(at(3700)).lost.empty());
  // What is sent instead arrives, and tells of the others.
  send(sent, 5, at(3700));
  CHECK(numbers(sent.on_ack(at(3800), ack({{5, 6}, {0, 2}})).lost) ==
        std::vector<std::uint64_t>{3, 4});
}

TEST_CASE("an hour of silence changes nothing") {
  SentPackets sent;
  send(sent, 0, at(0));
  sent.on_ack(at(50), ack({{0, 1}}));
  const MeshTime later = at(0) + hours{1};
  send(sent, 1, later);
  const auto settled = sent.on_ack(later + milliseconds{50}, ack({{0, 2}}));
  CHECK(numbers(settled.acked) == std::vector<std::uint64_t>{1});
  CHECK(*sent.smoothed_rtt() == milliseconds{50});
}

TEST_CASE("acknowledgements of what was never sent are ignored") {
  SentPackets sent;
  send(sent, 5, at(0));
  CHECK(sent.on_ack(at(10), ack({{0, 1000}})).acked.empty());
  CHECK(sent.on_ack(at(10), ack({})).acked.empty());
  CHECK(sent.on_ack(at(10), ack({{2, 4}})).acked.empty());
  CHECK(sent.packets_in_flight() == 1);
}

TEST_CASE("each ticket is told, and memory stays bounded, when nothing ever arrives") {
  SentPackets sent;
  std::size_t lost = 0;
  std::uint64_t number = 0;
  for (int i = 0; i < 200'000; ++i) {
    const MeshTime now = at(i);
    lost += sent.on_time(now).lost.size();
    if (sent.room()) send(sent, number++, now);
  }
  lost += sent.abandon().size();
  CHECK(lost == number);
  CHECK(sent.packets_in_flight() == 0);
  CHECK(sent.memory_bytes() <= SentPackets::kPacketsMax * 400);
}

TEST_CASE("one record too many makes the oldest forgotten, as lost, and the rest goes on") {
  SentPackets sent;
  for (std::uint64_t i = 0; i < SentPackets::kPacketsMax + 3; ++i) send(sent, i, at(1));
  CHECK(sent.packets_in_flight() == SentPackets::kPacketsMax);
  CHECK(sent.loss_time() <= at(1));
  CHECK(numbers(sent.on_time(at(1)).lost) == std::vector<std::uint64_t>{0, 1, 2});
  CHECK(sent.loss_time() > at(1));
  const auto settled = sent.on_ack(at(2), ack({{0, 10}}));
  CHECK(numbers(settled.acked) == std::vector<std::uint64_t>{3, 4, 5, 6, 7, 8, 9});
  CHECK(sent.memory_bytes() <= SentPackets::kPacketsMax * 400);
}

TEST_CASE("an acknowledgement that comes absurdly late makes nobody wait for long") {
  SentPackets sent;
  send(sent, 0, at(0));
  sent.on_ack(at(3'600'000), ack({{0, 1}}));
  CHECK(*sent.smoothed_rtt() <= seconds{5});
  send(sent, 1, at(3'600'000));
  CHECK(sent.loss_time() <= at(3'600'000) + seconds{10});
}

TEST_CASE("a delay longer than the packet is away tells nothing of the round trip") {
  SentPackets sent;
  send(sent, 0, at(0));
  sent.on_ack(at(100), ack({{0, 1}}));
  send(sent, 1, at(200));
  AckFrame absurd = ack({{0, 2}});
  absurd.delay = milliseconds{400};
  const auto settled = sent.on_ack(at(300), absurd);
  REQUIRE(settled.report.largest);
  CHECK_FALSE(settled.report.largest->rtt);
  CHECK(*sent.smoothed_rtt() == milliseconds{100});
}

TEST_CASE("a packet in flight is offered for repetition once, the oldest first") {
  SentPackets sent;
  send(sent, 0, at(0));
  send(sent, 1, at(10));
  CHECK_FALSE(sent.take_repeat(at(0)));
  CHECK(numbers(*sent.take_repeat(at(50))) == std::vector<std::uint64_t>{0});
  CHECK(numbers(*sent.take_repeat(at(50))) == std::vector<std::uint64_t>{1});
  CHECK_FALSE(sent.take_repeat(at(50)));
}

}  // namespace
}  // namespace warren::mesh
