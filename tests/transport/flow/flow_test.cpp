// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/flow.hpp"

#include <deque>

#include <doctest/doctest.h>

#include "transfer.hpp"

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Flow::Sent packet(std::uint64_t number) {
  return {.number = number,
          .ip_bytes = 500,
          .wants_ack = true,
          .backlogged = true,
          .tickets = {MapTicket{number, MapClass::kFresh}}};
}

TEST_CASE("nothing is known at first, and a few packets may go") {
  Flow flow({});
  CHECK_FALSE(flow.quality().rtt);
  CHECK(flow.quality().rate_bit_s == 0.0);
  std::uint64_t sent = 0;
  MeshTime now{seconds{1}};
  while (flow.may_send(now) && sent < 100) flow.on_sent(now += milliseconds{1}, packet(sent++));
  CHECK(sent >= 4);
  CHECK(sent <= 10);
}

TEST_CASE("all that is in flight is told lost when the peer is no more") {
  Flow flow({});
  for (std::uint64_t i = 0; i < 5; ++i) flow.on_sent(MeshTime{seconds{1}}, packet(i));
  CHECK(flow.abandon().lost.size() == 5);
  CHECK(flow.abandon().lost.empty());
}

TEST_CASE("in silence only single packets go out; what is heard brings one at once") {
  Flow flow({});
  MeshTime now{seconds{1}};
  flow.on_sent(now, packet(0));
  std::uint64_t sent = 1;
  const auto drive = [&](Duration span) {
    const std::uint64_t before = sent;
    for (const MeshTime end = now + span; now < end; now += milliseconds{1}) {
      flow.on_time(now);
      if (flow.may_send(now)) flow.on_sent(now, packet(sent++));
    }
    return sent - before;
  };
  drive(seconds{10});
  const auto while_silent = drive(seconds{10});
  CHECK(while_silent >= 20);
  CHECK(while_silent <= 60);
  while (flow.may_send(now)) flow.on_sent(now, packet(sent++));
  CHECK_FALSE(flow.may_send(now + milliseconds{5}));
  flow.on_heard(now + milliseconds{200});
  CHECK(flow.may_send(now + milliseconds{200}));
}

TEST_CASE("who only receives and acknowledges is not silent, and has no deadline behind it") {
  Flow flow({});
  std::uint64_t sent = 0;
  MeshTime now{seconds{1}};
  for (std::uint64_t i = 0; i < 500; ++i) {
    now += milliseconds{10};
    flow.on_received(now, {i, 1000, true});
    flow.on_time(now);
    CHECK(flow.next_time() > now - milliseconds{30});
    if (flow.ack_due(now)) {
      REQUIRE(flow.take_ack(now));
      flow.on_sent(now, {.number = sent++, .ip_bytes = 80, .tickets = {}});
    }
  }
  for (int i = 0; i < 5; ++i) {
    REQUIRE(flow.may_send(now));
    flow.on_sent(now, packet(sent++));
  }
}

TEST_CASE("in silence no deadline lies in the past") {
  Flow flow({});
  flow.on_sent(MeshTime{seconds{1}}, packet(0));
  flow.on_time(MeshTime{seconds{20}});
  flow.on_heard(MeshTime{seconds{21}});
  flow.on_time(MeshTime{seconds{21}});
  CHECK(flow.next_time() > MeshTime{seconds{21}});
}

TEST_CASE("answers to somebody who acknowledges nothing are bounded, and each ticket comes back") {
  Flow flow({});
  MeshTime now{seconds{1}};
  flow.on_sent(now, packet(0));
  AckFrame absurd;
  absurd.ranges = {{0, 1}};
  flow.on_ack(now += seconds{30}, absurd);
  std::uint64_t sent = 1;
  std::size_t lost = 0;
  for (int i = 0; i < 100'000; ++i) {
    lost += flow.on_time(now += milliseconds{1}).lost.size();
    if (flow.may_send_at_once(now)) flow.on_sent(now, packet(sent++));
  }
  CHECK(sent >= 100);
  CHECK(sent <= 5'000);
  // Even one that asks nobody does no harm.
  for (int i = 0; i < 50'000; ++i) flow.on_sent(now, packet(sent++));
  lost += flow.on_time(now).lost.size() + flow.abandon().lost.size();
  CHECK(lost == sent - 1);
}

// One hello, a pause, then as much as may go, over 50 kbit/s: the highest rate that was ever held
// for the link's, bit/s.
double highest_rate_after(Duration pause) {
  struct UnderWay {
    MeshTime at;
    std::uint64_t number = 0;
  };
  Flow sender({}), receiver({});
  NodePacer pacer(std::nullopt);
  pacer.want(1, true);
  std::deque<UnderWay> there;
  std::deque<std::pair<MeshTime, AckFrame>> back;
  std::uint64_t sent = 0;
  MeshTime link_free{};
  double highest = 0.0;
  const MeshTime start{seconds{1}};
  const auto send = [&](MeshTime now) {
    const bool backlogged = pacer.on_sent(now, 1, 400, sender.pace());
    Flow::Sent full = packet(sent);
    full.ip_bytes = 400;
    full.backlogged = backlogged;
    sender.on_sent(now, full);
    link_free = std::max(link_free, now) + milliseconds{64};
    there.push_back({link_free + milliseconds{25}, sent++});
  };
  send(start);
  for (MeshTime now = start; now < start + pause + seconds{1}; now += milliseconds{1}) {
    sender.on_time(now);
    while (!there.empty() && there.front().at <= now) {
      receiver.on_received(now, {there.front().number, 400, true});
      there.pop_front();
    }
    if (receiver.ack_due(now)) back.emplace_back(now + milliseconds{25}, *receiver.take_ack(now));
    while (!back.empty() && back.front().first <= now) {
      sender.on_ack(now, back.front().second);
      back.pop_front();
    }
    highest = std::max(highest, sender.quality().rate_bit_s);
    if (now < start + pause) continue;
    while (sender.may_send(now) && pacer.next(now)) send(now);
  }
  return highest;
}

TEST_CASE("a pause after the first packet does not make a slow link look fast") {
  for (const int pause_ms : {100, 500, 900, 1050, 1500, 10'000}) {
    CAPTURE(pause_ms);
    const double rate = highest_rate_after(milliseconds{pause_ms});
    CHECK(rate >= 30'000.0);
    CHECK(rate <= 80'000.0);
  }
}

TEST_CASE("it is told when there will be room although no acknowledgement comes") {
  TransferConfig config;
  config.flows = {{}};
  Transfer transfer(config);
  transfer.run_until(seconds{5});
  Flow flow = transfer.sender(0);
  MeshTime now = transfer.now();
  std::uint64_t number = transfer.packets_sent(0);
  flow.on_time(now);
  while (flow.may_send(now)) flow.on_sent(now, packet(number++));
  int sent = 0;
  for (const MeshTime end = now + milliseconds{600}; now < end;) {
    now = std::max(flow.next_time(), now + Duration{1});
    flow.on_time(now);
    if (!flow.may_send(now)) continue;
    flow.on_sent(now, packet(number++));
    ++sent;
  }
  // 1 Mbit/s for half a second, in packets of 500 bytes.
  CHECK(sent >= 90);
}

TEST_CASE("the quality of the link is told") {
  TransferConfig config;
  config.there.loss = 0.1;
  config.back.loss = 0.0;
  config.flows = {{}};
  Transfer transfer(config);
  transfer.run_until(seconds{20});
  const LinkQuality quality = transfer.sender(0).quality();
  REQUIRE(quality.rtt);
  CHECK(*quality.rtt >= milliseconds{60});
  CHECK(*quality.rtt <= milliseconds{140});
  CHECK(quality.rate_bit_s == doctest::Approx(1e6).epsilon(0.05));
  CHECK(quality.loss_out == doctest::Approx(0.1).epsilon(0.9));
  CHECK(quality.queue <= milliseconds{60});
}

TEST_CASE("the same seed gives the same run") {
  const auto run = [] {
    TransferConfig config;
    config.there.loss = config.back.loss = 0.2;
    config.there.jitter = milliseconds{10};
    config.flows = {{.app_bytes = 300'000}};
    Transfer transfer(config);
    transfer.run();
    return std::pair(transfer.finished(0), transfer.data_bytes_sent(0));
  };
  CHECK(run() == run());
}

}  // namespace
}  // namespace warren::mesh
