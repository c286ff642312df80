// SPDX-License-Identifier: Apache-2.0
#include "tools/link/capacity.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace warren;
using namespace std::chrono_literals;

namespace {

constexpr LinkNanoseconds kMs = 1'000'000;

}  // namespace

TEST_CASE("without a limit bytes pass at once") {
  CHECK(Capacity().after({}, 5 * kMs, 1500).at == 5 * kMs);
}

TEST_CASE("bytes pass at the rate, one packet after the other") {
  const Capacity capacity(1e6);
  const CapacityUse first = capacity.after({}, 0, 1250);
  CHECK(first.at == 10 * kMs);
  CHECK(capacity.after(first, 3 * kMs, 1250).at == 20 * kMs);
  CHECK(capacity.after(first, 15 * kMs, 1250).at == 25 * kMs);
}

TEST_CASE("a packet that a change of rate falls into is sent at both rates") {
  const Capacity capacity({{0ms, 1e6}, {5ms, 1e5}, {15ms, 1e6}});
  // 5000 bits at first, 1000 in the slow time, the rest at the end.
  CHECK(capacity.after({}, 0, 1250).at == 19 * kMs);
}

TEST_CASE("at rate 0 a packet waits for the next step, or for ever") {
  CHECK(Capacity({{0ms, 0.0}, {7ms, 1e6}}).after({}, 0, 125).at == 8 * kMs);
  CHECK(Capacity({{0ms, 1e6}, {1ms, 0.0}}).after({}, 0, 1250).at == kNeverPasses);
}

TEST_CASE("an opportunity carries its bytes, also of several packets, and is lost if unused") {
  const Capacity capacity(Opportunities{{10, 20, 20, 50}});
  CapacityUse use = capacity.after({}, 0, 1000);
  CHECK(use.at == 10 * kMs);
  use = capacity.after(use, 0, 504);
  CHECK(use.at == 10 * kMs);
  use = capacity.after(use, 0, 1504);  // the first of two at 20 ms
  CHECK(use.at == 20 * kMs);
  use = capacity.after(use, 0, 1505);  // the second and one byte of the last
  CHECK(use.at == 50 * kMs);
  CHECK(capacity.after(use, 51 * kMs, 1503).at == 60 * kMs);
  CHECK(capacity.after(use, 0, 1503).at == 50 * kMs);
}

TEST_CASE("opportunities start over at the last one's time") {
  const Capacity capacity(Opportunities{{0, 4, 10}});
  CHECK(capacity.after({}, 11 * kMs, 1504).at == 14 * kMs);
  CHECK(capacity.after({}, 1000 * kMs, 1504).at == 1000 * kMs);
  CHECK(capacity.after({}, 1005 * kMs, 2 * 1504).at == 1010 * kMs);
}

TEST_CASE("a full queue uses every opportunity exactly once") {
  CHECK(rc::check("as a walk over the list says", [](const std::vector<std::uint8_t>& gaps) {
    RC_PRE(!gaps.empty());
    Opportunities list;
    std::uint32_t now = 0;
    for (const auto gap : gaps) list.at_ms.push_back(now += gap % 8);
    RC_PRE(now > 0);
    const Capacity capacity(list);
    CapacityUse use;
    for (std::size_t i = 0; i < 3 * gaps.size(); ++i) {
      use = capacity.after(use, 0, Opportunities::kOpportunityBytes);
      const auto expected = (i / gaps.size()) * now + list.at_ms[i % gaps.size()];
      RC_ASSERT(use.at == static_cast<LinkNanoseconds>(expected) * kMs);
    }
  }));
}
