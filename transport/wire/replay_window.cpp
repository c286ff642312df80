// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/replay_window.hpp"

#include <algorithm>
#include <cassert>

namespace warren::mesh {
namespace {

constexpr std::uint64_t kWordBits = 64;

}  // namespace

bool ReplayWindow::is_new(std::uint64_t number) const {
  if (number >= end_) return true;
  if (end_ - number > kWidth) return false;
  const std::uint64_t place = number % kWidth;
  return (seen_[place / kWordBits] >> place % kWordBits & 1) == 0;
}

void ReplayWindow::mark(std::uint64_t number) {
  assert(is_new(number));
  // A number's place is that of the one kWidth before it: what is left behind is cleared.
  const std::uint64_t first = number >= end_ + kWidth ? number - kWidth + 1 : end_;
  for (std::uint64_t next = first; next <= number; ++next) {
    const std::uint64_t place = next % kWidth;
    seen_[place / kWordBits] &= ~(std::uint64_t{1} << place % kWordBits);
  }
  const std::uint64_t place = number % kWidth;
  seen_[place / kWordBits] |= std::uint64_t{1} << place % kWordBits;
  end_ = std::max(end_, number + 1);
}

}  // namespace warren::mesh
