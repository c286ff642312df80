// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/beacon_clock.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Beacons within the time, each at the moment that the clock says.
int beacons(BeaconClock& clock, const BeaconClock::Surroundings& surroundings, Duration time) {
  MeshTime now{};
  int count = 0;
  while (now < MeshTime(time)) {
    clock.on_sent(now, surroundings);
    ++count;
    now = clock.next();
  }
  return count;
}

TEST_CASE("who hears nobody beacons four to five times a second, forever") {
  BeaconClock clock(1);
  const int count = beacons(clock, {0, false, 80}, std::chrono::hours(1));
  CHECK(count >= 3600 * 4);
  CHECK(count <= 3600 * 5);
}

TEST_CASE("who hears others stays below a kilobit per second") {
  for (const std::size_t neighbours : {1U, 5U, 30U}) {
    for (const std::size_t bytes : {72U, 111U, 131U, 262U}) {
      BeaconClock clock(2);
      const int count = beacons(clock, {neighbours, false, bytes}, seconds(1000));
      CHECK(count * static_cast<int>(bytes) * 8 <= 1000 * 1000);
    }
  }
}

TEST_CASE("the next beacon comes no later than was told") {
  BeaconClock clock(3);
  MeshTime now{};
  for (int i = 0; i < 1000; ++i) {
    const BeaconClock::Surroundings surroundings{static_cast<std::size_t>(i % 40), i % 7 == 0, 100};
    clock.on_sent(now, surroundings);
    CHECK(clock.next() <= now + BeaconClock::longest(surroundings));
    CHECK(clock.next() > now);
    now = clock.next();
  }
}

TEST_CASE("hurry is soon, and no flood") {
  BeaconClock clock(4);
  MeshTime now(seconds(5));
  clock.on_sent(now, {5, false, 100});
  clock.hurry(now + milliseconds(1));
  CHECK(clock.next() == now + BeaconClock::kHurriedLeast);
  clock.on_sent(now, {5, false, 100});
  clock.hurry(now + milliseconds(500));
  CHECK(clock.next() <= now + milliseconds(520));
}

}  // namespace
}  // namespace warren::mesh
