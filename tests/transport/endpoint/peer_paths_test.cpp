// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/peer_paths.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr MeshTime kStart(seconds(10));

MeshPath path(InterfaceIndex interface, std::uint8_t host) {
  MeshAddress address;
  address.ip[15] = host;
  address.port = 7;
  return {interface, false, address};
}

TEST_CASE("the newest pair packet says where the peer is") {
  PeerPaths paths(1);
  CHECK_FALSE(paths.current());
  CHECK_FALSE(paths.on_pair_packet(kStart, path(0, 1), true));
  CHECK(paths.current() == path(0, 1));
  CHECK(paths.on_pair_packet(kStart, path(0, 2), true));
  CHECK(paths.current() == path(0, 2));
  CHECK_FALSE(paths.on_pair_packet(kStart, path(0, 1), false));  // overtaken on its way
  CHECK(paths.current() == path(0, 2));
}

TEST_CASE("beacons move nothing") {
  PeerPaths paths(1);
  paths.on_pair_packet(kStart, path(0, 1), true);
  paths.on_beacon(kStart, path(0, 9), seconds(1));
  CHECK(paths.current() == path(0, 1));
}

TEST_CASE("a beacon from an unproved address is worth a probe, but few") {
  PeerPaths paths(2);
  paths.on_pair_packet(kStart, path(0, 1), true);
  CHECK_FALSE(paths.take_probe(kStart, path(0, 1)));
  CHECK(paths.take_probe(kStart, path(1, 5)));
  CHECK_FALSE(paths.take_probe(kStart + milliseconds(100), path(1, 5)));
  CHECK(paths.take_probe(kStart + PeerPaths::kProbeLeast, path(1, 5)));
}

TEST_CASE("when an interface falls silent the other takes over, and does not give way at once") {
  PeerPaths paths(2);
  paths.on_pair_packet(kStart, path(0, 1), true);
  paths.on_pair_packet(kStart, path(1, 5), true);
  CHECK(paths.current() == path(0, 1));
  MeshTime now = kStart;
  for (int i = 0; i < 5; ++i) {
    now += seconds(1);
    paths.on_beacon(now, path(1, 5), seconds(1));
  }
  CHECK(paths.choose(now));
  CHECK(paths.current() == path(1, 5));
  paths.on_beacon(now, path(0, 1), seconds(1));
  CHECK_FALSE(paths.choose(now));
}

TEST_CASE("of two paths that are heard the one that loses less is used") {
  PeerPaths paths(2);
  paths.on_pair_packet(kStart, path(0, 1), true);
  paths.on_pair_packet(kStart, path(1, 5), true);
  paths.on_beacon(kStart, path(0, 1), seconds(1));
  paths.on_beacon(kStart, path(1, 5), seconds(1));
  paths.note_quality(0.4, milliseconds(20));
  CHECK(paths.choose(kStart + milliseconds(500)));
  CHECK(paths.current() == path(1, 5));
}

TEST_CASE("a second address on the same interface is left alone while the proved one is heard") {
  PeerPaths paths(1);
  paths.on_pair_packet(kStart, path(0, 1), true);
  MeshTime now = kStart;
  for (int i = 0; i < 20; ++i) {
    now += seconds(1);
    paths.on_beacon(now, path(0, 1), seconds(1));
    CHECK_FALSE(paths.take_probe(now, path(0, 2)));
  }
  now += PeerPaths::kStaleLeast + seconds(1);
  CHECK(paths.take_probe(now, path(0, 2)));
}

TEST_CASE(
    "a path that was bad is used again when its beacons come through and the other is worse") {
  PeerPaths paths(2);
  paths.on_pair_packet(kStart, path(0, 1), true);
  paths.on_pair_packet(kStart, path(1, 5), true);
  paths.on_beacon(kStart, path(0, 1), seconds(1));
  paths.on_beacon(kStart, path(1, 5), seconds(1));
  paths.note_quality(0.8, milliseconds(20));
  MeshTime now = kStart + milliseconds(500);
  REQUIRE(paths.choose(now));
  REQUIRE(paths.current() == path(1, 5));
  // Beacons pass on both; where we are, a third of the packets is lost.
  for (int i = 0; i < 40; ++i) {
    now += milliseconds(900);
    paths.on_beacon(now, path(0, 1), seconds(1));
    paths.on_beacon(now, path(1, 5), seconds(1));
  }
  paths.note_quality(0.3, milliseconds(20));
  CHECK(paths.choose(now));
  CHECK(paths.current() == path(0, 1));
}

}  // namespace
}  // namespace warren::mesh
