// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/flow.hpp"

#include <doctest/doctest.h>

#include "transfer.hpp"

namespace warren {
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
  CHECK_FALSE(flow.quality(MeshTime{}).rtt);
  CHECK(flow.quality(MeshTime{}).rate_bit_s == 0.0);
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

TEST_CASE("the quality of the link is told") {
  TransferConfig config;
  config.there.loss = 0.1;
  config.back.loss = 0.0;
  config.flows = {{}};
  Transfer transfer(config);
  transfer.run_until(seconds{20});
  const LinkQuality quality = transfer.sender(0).quality(transfer.now());
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
}  // namespace warren
