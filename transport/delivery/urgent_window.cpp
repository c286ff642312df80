// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/urgent_window.hpp"

namespace warren::mesh {

bool UrgentWindow::take(std::uint32_t number) {
  const std::uint32_t ahead = latest_ ? number - *latest_ : 0;
  const bool newer = !latest_ || (ahead != 0 && ahead < 0x8000'0000U);
  if (newer) {
    if (!latest_ || ahead >= kWidth) {
      come_.reset();
    } else {
      for (std::uint32_t i = 1; i <= ahead; ++i) come_.reset((*latest_ + i) % kWidth);
    }
    latest_ = number;
  } else if (*latest_ - number >= kWidth || come_.test(number % kWidth)) {
    return false;
  }
  come_.set(number % kWidth);
  return true;
}

}  // namespace warren::mesh
