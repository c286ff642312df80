// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/unconfirmed_boots.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

using Verdict = UnconfirmedBoots::Verdict;

UnconfirmedBoots::Boot boot(std::uint64_t bits, MeshTime now, std::uint64_t number = 0) {
  UnconfirmedBoots::Boot told{{bits}, {1}, {}};
  told.number = number;
  told.answer_at = now + milliseconds(5);
  return told;
}

TEST_CASE("an answer is due once per beacon, at its time") {
  UnconfirmedBoots boots;
  const MeshTime now(seconds(1));
  CHECK(boots.on_beacon(now, boot(7, now)) == Verdict::kFirst);
  CHECK(boots.on_beacon(now, boot(7, now + seconds(1), 1)) == Verdict::kKnown);  // is due already
  CHECK_FALSE(boots.take_due(now));
  CHECK(boots.next() == now + milliseconds(5));
  CHECK(boots.take_due(boots.next())->boot == BootId{7});
  CHECK(boots.next() == kNever);
}

TEST_CASE("a flood of boots takes bounded memory and gets few answers") {
  UnconfirmedBoots boots;
  int answers = 0;
  const MeshTime start(seconds(1));
  for (int i = 0; i < 100'000; ++i) {
    const MeshTime now = start + i * Duration(100);  // ten seconds in all
    boots.on_beacon(now, boot(static_cast<std::uint64_t>(i), now));
    while (boots.take_due(now)) ++answers;
    CHECK(boots.size() <= UnconfirmedBoots::kMax);
  }
  CHECK(answers <= 32 + 16 * 10);
  CHECK(answers > 50);
}

TEST_CASE("one recorded beacon, however often it comes, gets one answer") {
  UnconfirmedBoots boots;
  int answers = 0;
  for (int i = 0; i < 1000; ++i) {
    const MeshTime now = MeshTime(seconds(1)) + i * milliseconds(50);
    boots.on_beacon(now, boot(7, now, 3));
    while (boots.take_due(now + milliseconds(5))) ++answers;
  }
  CHECK(answers == 1);
}

TEST_CASE("who never reacts gets fewer answers") {
  UnconfirmedBoots boots;
  int answers = 0;
  for (int i = 0; i < 1000; ++i) {  // fifty seconds of recorded beacons
    const MeshTime now = MeshTime(seconds(1)) + i * milliseconds(50);
    boots.on_beacon(now, boot(7, now, static_cast<std::uint64_t>(i)));
    while (boots.take_due(now + milliseconds(5))) ++answers;
  }
  CHECK(answers >= 16);
  CHECK(answers <= 28);
}

TEST_CASE("a confirmed boot is forgotten") {
  UnconfirmedBoots boots;
  const MeshTime now(seconds(1));
  boots.on_beacon(now, boot(7, now));
  boots.forget({7});
  CHECK(boots.size() == 0);
  CHECK(boots.next() == kNever);
}

}  // namespace
}  // namespace warren::mesh
