// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/liveness.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr MeshTime kStart(seconds(100));

TEST_CASE("hearing alone is not enough: the other must hear too") {
  Liveness liveness;
  liveness.on_beacon(kStart, seconds(1));
  CHECK_FALSE(liveness.update(kStart));
  CHECK_FALSE(liveness.up());
  liveness.on_hears_us(kStart);
  CHECK(liveness.update(kStart) == true);
}

TEST_CASE("a pair packet proves both directions") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  CHECK(liveness.update(kStart) == true);
  CHECK_FALSE(liveness.update(kStart));  // told once
}

TEST_CASE("three beacons missing are no reason to go down, ten are") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  liveness.on_beacon(kStart, seconds(1));
  liveness.update(kStart);
  CHECK_FALSE(liveness.update(kStart + milliseconds(3900)));
  CHECK(liveness.overdue(kStart + milliseconds(3900)));
  CHECK(liveness.update(kStart + seconds(10)) == false);
}

TEST_CASE("the deadline is where it goes down") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  liveness.update(kStart);
  const MeshTime end = liveness.next();
  CHECK_FALSE(liveness.update(end - Duration(2)));
  CHECK(liveness.update(end) == false);
  CHECK(liveness.next() == kNever);
}

TEST_CASE("after going down a beacon alone does not bring it up") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  liveness.update(kStart);
  const MeshTime later = kStart + seconds(8);
  CHECK(liveness.update(later) == false);
  liveness.on_beacon(later, seconds(1));
  CHECK_FALSE(liveness.update(later));
  liveness.on_hears_us(later);
  CHECK(liveness.update(later) == true);
}

TEST_CASE("who is heard but does not hear us for long goes down") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  liveness.update(kStart);
  bool down = false;
  for (int second = 1; second < 60; ++second) {
    liveness.on_beacon(kStart + seconds(second), seconds(1));
    down = down || liveness.update(kStart + seconds(second)) == false;
  }
  CHECK(down);
}

TEST_CASE("in a crowd a member's turn in the lists may take longer") {
  constexpr std::size_t kCrowd = 250;
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  MeshTime now = kStart;
  // Named in one list of 31, each a second after the last.
  for (int i = 1; i <= 3 * 31; ++i) {
    now += seconds(1);
    liveness.on_beacon(now, seconds(1), kCrowd);
    if (i % 31 == 0) liveness.on_hears_us(now);
    const auto changed = liveness.update(now);
    CHECK((!changed || *changed));
  }
  CHECK(liveness.up());
}

TEST_CASE("no told period keeps a member up forever") {
  Liveness liveness;
  liveness.on_pair_packet(kStart);
  liveness.on_beacon(kStart, std::chrono::hours(100));
  liveness.update(kStart);
  CHECK(liveness.update(kStart + seconds(200)) == false);
}

}  // namespace
}  // namespace warren::mesh
