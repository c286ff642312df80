// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/replay_window.hpp"

#include <set>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/wire/random_frames.hpp"
#include "transport/wire/envelope.hpp"

using namespace warren;
using namespace warren::mesh;

namespace {

// The definition, with all numbers kept.
class PlainWindow {
 public:
  bool is_new(std::uint64_t number) const {
    if (seen_.empty()) return true;
    return number + ReplayWindow::kWidth > *seen_.rbegin() && !seen_.contains(number);
  }
  void mark(std::uint64_t number) { seen_.insert(number); }

 private:
  std::set<std::uint64_t> seen_;
};

}  // namespace

TEST_CASE("a number is taken once, and none that is too old, in whatever order they come") {
  CHECK(rc::check("as the set of all numbers says", [](std::uint64_t seed) {
    test::Random random(seed);
    ReplayWindow window;
    PlainWindow plain;
    std::uint64_t around = random() % 2 == 0 ? 0 : test::any_up_to(random, kPacketNumberEnd - 9999);
    for (int i = 0; i < 2000; ++i) {
      around += test::any_up_to(random, random() % 50 == 0 ? 5000 : 20);
      const std::uint64_t back = test::any_up_to(random, 4 * ReplayWindow::kWidth);
      const std::uint64_t number = around - std::min(around, back);
      RC_ASSERT(window.is_new(number) == plain.is_new(number));
      if (!window.is_new(number)) continue;
      window.mark(number);
      plain.mark(number);
      RC_ASSERT(!window.is_new(number));
    }
  }));
}

TEST_CASE("the window is as wide as it says") {
  ReplayWindow window;
  window.mark(10'000);
  CHECK(window.is_new(10'000 - ReplayWindow::kWidth + 1));
  CHECK_FALSE(window.is_new(10'000 - ReplayWindow::kWidth));
  CHECK(window.is_new(kPacketNumberEnd - 1));
  window.mark(kPacketNumberEnd - 1);
  CHECK_FALSE(window.is_new(10'000));
}
