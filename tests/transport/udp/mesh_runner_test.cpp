// SPDX-License-Identifier: Apache-2.0
// Whole nodes over real sockets. What the endpoint promises is tested in virtual time; here, that
// the shell drives it.
#include "transport/udp/mesh_runner.hpp"

#include <future>
#include <thread>

#include <doctest/doctest.h>

#include "tests/transport/udp/network_namespace.hpp"
#include "tests/transport/udp/runner_node.hpp"

using namespace warren;
using namespace warren::mesh;
using test::CabledNamespaces;
using test::count_of;
using test::RunnerNode;
using Events = std::vector<MeshEvent>;

namespace {

using Bytes = std::vector<std::uint8_t>;

MeshSocketsConfig radio(bool ipv6 = false) {
  return {.interfaces = {{"radio0", !ipv6, ipv6, false}}};
}

bool has_up(const Events& events) { return count_of<MemberUp>(events) > 0; }

}  // namespace

TEST_CASE("nodes find each other and everything that they offer goes through, by IPv4 and IPv6") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  for (const bool ipv6 : {false, true}) {
    CAPTURE(ipv6);
    RunnerNode ann(cable->first, 1, radio(ipv6));
    RunnerNode bob(cable->second, 2, radio(ipv6));
    REQUIRE(ann.until(has_up));
    REQUIRE(bob.until(has_up));
    ann.post([&](Endpoint& endpoint, MeshTime now) {
      ann.map().left = 50;
      CHECK(endpoint.send_urgent(now, std::nullopt, Bytes{1}));
      CHECK(endpoint.set_telemetry(now, 5, Bytes{2}));
      CHECK(endpoint.send_parcel(now, {2}, ParcelClass::kMessage, Bytes(100'000, 3)));
      endpoint.wake(now, {2});
    });
    REQUIRE(bob.until([](const Events& events) {
      return count_of<UrgentArrived>(events) == 1 && count_of<TelemetryArrived>(events) == 1 &&
             count_of<ParcelArrived>(events) == 1 && count_of<MapArrived>(events) >= 50;
    }));
    bob.post([&](Endpoint& endpoint, MeshTime now) {
      bob.until([&](const Events& events) {
        for (const MeshEvent& event : events) {
          const auto* parcel = std::get_if<ParcelArrived>(&event);
          if (parcel != nullptr) endpoint.finish_parcel(now, parcel->from, parcel->key);
        }
        return true;
      });
    });
    CHECK(ann.until([](const Events& events) { return count_of<ParcelDelivered>(events) == 1; }));
  }
}

TEST_CASE("what goes to several group addresses counts as often") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  MeshSocketsConfig config = radio();
  config.interfaces[0].broadcast = true;
  RunnerNode ann(cable->first, 1, config);  // alone: beacons only
  struct Sent {
    std::uint64_t by_endpoint = 0;
    std::uint64_t by_sockets = 0;
    std::uint64_t datagrams = 0;
  };
  const auto sent = [&] {
    std::promise<Sent> told;
    ann.post([&](const Endpoint& endpoint, MeshTime) {
      const SocketCounts& counts = ann.sockets().counts(0);
      told.set_value(
          {endpoint.counts().ip_bytes_out, counts.bytes_sent + 28 * counts.sent, counts.sent});
    });
    return told.get_future().get();
  };
  Sent before = sent();
  for (int i = 0; i < 400 && before.datagrams == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    before = sent();
  }
  REQUIRE(before.datagrams > 0);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const Sent after = sent();
  CHECK(after.datagrams >= before.datagrams + 4);
  CHECK(after.by_endpoint - before.by_endpoint == after.by_sockets - before.by_sockets);
}

TEST_CASE("a cut cable is noticed, and the session goes on when it is whole again") {
  const auto cable = CabledNamespaces::make();
  if (!cable) return;
  RunnerNode ann(cable->first, 1, radio());
  RunnerNode bob(cable->second, 2, radio());
  REQUIRE(ann.until(has_up));
  REQUIRE(bob.until(has_up));
  REQUIRE(cable->second.ip("link set radio0 down"));
  const auto parcel = [](Endpoint& endpoint, MeshTime now) {
    CHECK(endpoint.send_parcel(now, {2}, ParcelClass::kControl, Bytes(10)));
  };
  ann.post(parcel);
  REQUIRE(ann.until([](const Events& events) { return count_of<MemberDown>(events) == 1; }));
  REQUIRE(cable->second.ip("link set radio0 up"));
  REQUIRE(bob.until([](const Events& events) { return count_of<ParcelArrived>(events) == 1; }));
  CHECK(bob.until([](const Events& events) { return count_of<MemberRestarted>(events) == 0; }));
}
