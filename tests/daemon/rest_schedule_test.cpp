// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/rest_schedule.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace warren {

TEST_CASE("what has not changed for long enough may rest, at most an eighth later") {
  CHECK(rc::check("for any wait", [] {
    const std::uint32_t after = *rc::gen::inRange(1U, 1000U);
    RestSchedule schedule(after);
    const std::uint32_t slack = (after + 7) / 8;
    for (std::uint32_t tick = 1; tick < 3 * after + 3; ++tick) {
      // The revision of each tick is its number.
      const std::uint32_t may_rest = schedule.tick({tick}).number;
      RC_ASSERT(may_rest + after <= tick || may_rest == 0U);
      RC_ASSERT(may_rest + after + slack >= tick);
      RC_ASSERT(schedule.marks() <= 10U);
    }
  }));
}

TEST_CASE("a layer that nobody writes rests once it has been held for long enough") {
  RestSchedule schedule(3);
  for (int tick = 0; tick < 3; ++tick) CHECK(schedule.tick({7}) == Revision{0});
  CHECK(schedule.tick({7}) == Revision{7});
}

}  // namespace warren
