// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/unconfirmed_boots.hpp"

#include <doctest/doctest.h>

namespace warren {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

UnconfirmedBoots::Boot boot(std::uint64_t bits, MeshTime now) {
  return {{bits}, {1}, {}, now, now + milliseconds(5)};
}

TEST_CASE("an answer is due once per beacon, at its time") {
  UnconfirmedBoots boots;
  const MeshTime now(seconds(1));
  CHECK(boots.heard(now, boot(7, now)));
  CHECK(boots.heard(now, boot(7, now + seconds(1))));  // is due already
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
    boots.heard(now, boot(static_cast<std::uint64_t>(i), now));
    while (boots.take_due(now)) ++answers;
    CHECK(boots.size() <= UnconfirmedBoots::kMax);
  }
  CHECK(answers <= 32 + 16 * 10);
  CHECK(answers > 50);
}

TEST_CASE("a confirmed boot is forgotten") {
  UnconfirmedBoots boots;
  const MeshTime now(seconds(1));
  boots.heard(now, boot(7, now));
  boots.forget({7});
  CHECK(boots.size() == 0);
  CHECK(boots.next() == kNever);
}

}  // namespace
}  // namespace warren
