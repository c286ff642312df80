// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/byte_ranges.hpp"

#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace warren;
using namespace warren::mesh;

namespace {

struct Change {
  bool add = false;
  NumberRange range;
};

rc::Gen<Change> some_change() {
  return rc::gen::apply(
      [](bool add, std::uint64_t first, std::uint64_t length) {
        return Change{add, {first, first + length}};
      },
      rc::gen::arbitrary<bool>(), rc::gen::inRange<std::uint64_t>(0, 60),
      rc::gen::inRange<std::uint64_t>(0, 12));
}

bool in_order_and_apart(const ByteRanges& ranges) {
  const NumberRange* before = nullptr;
  for (const NumberRange& range : ranges.ranges()) {
    if (range.first >= range.end) return false;
    if (before != nullptr && before->end >= range.first) return false;
    before = &range;
  }
  return true;
}

bool holds_all(const std::set<std::uint64_t>& numbers, NumberRange range) {
  for (std::uint64_t number = range.first; number < range.end; ++number) {
    if (!numbers.contains(number)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("ranges agree with a set of numbers") {
  CHECK(rc::check("ranges agree with a set of numbers", [] {
    const auto changes = *rc::gen::container<std::vector<Change>>(some_change());
    ByteRanges ranges;
    std::set<std::uint64_t> oracle;
    for (const auto& [add, range] : changes) {
      add ? ranges.add(range) : ranges.remove(range);
      for (std::uint64_t number = range.first; number < range.end; ++number)
        add ? void(oracle.insert(number)) : void(oracle.erase(number));
      RC_ASSERT(in_order_and_apart(ranges));
      RC_ASSERT(ranges.size() == oracle.size());
      for (std::uint64_t number = 0; number < 75; ++number)
        RC_ASSERT(ranges.contains(number) == oracle.contains(number));
    }
    const NumberRange asked = (*some_change()).range;
    RC_ASSERT(ranges.contains(asked) == holds_all(oracle, asked));
    const ByteRanges missing = ranges.missing_in(asked);
    for (std::uint64_t number = 0; number < 75; ++number) {
      const bool asked_for = asked.first <= number && number < asked.end;
      RC_ASSERT(missing.contains(number) == (asked_for && !oracle.contains(number)));
    }
  }));
}
