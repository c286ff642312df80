// SPDX-License-Identifier: Apache-2.0
#include "core/layer/range_coder.hpp"

#include <utility>

namespace warren {
namespace {

constexpr std::uint64_t kCarry = std::uint64_t{1} << 32;

}  // namespace

void RangeEncoder::rewind(const State& state) {
  state_ = state;
  bytes_.resize(state.written);
}

std::vector<std::uint8_t> RangeEncoder::finish() {
  // The range is wide enough to hold a number whose lower 24 bits are zeros, which are not sent.
  state_.low = (state_.low + kRangeMin - 1) & ~std::uint64_t{kRangeMin - 1};
  if (state_.withheld_count > 0) release_withheld();
  bytes_.push_back(static_cast<std::uint8_t>(state_.low >> 24));
  return std::exchange(bytes_, {});
}

void RangeEncoder::shift_byte_out() {
  const bool could_carry = state_.low >> 24 == 0xFF;
  if (state_.withheld_count > 0 && could_carry) {
    ++state_.withheld_count;
  } else {
    if (state_.withheld_count > 0) release_withheld();
    state_.withheld = static_cast<std::uint8_t>(state_.low >> 24);
    state_.withheld_count = 1;
  }
  state_.low = (state_.low & (kRangeMin - 1)) << 8;
}

void RangeEncoder::release_withheld() {
  const bool carry = state_.low >= kCarry;
  bytes_.push_back(static_cast<std::uint8_t>(state_.withheld + (carry ? 1 : 0)));
  bytes_.insert(bytes_.end(), state_.withheld_count - 1, carry ? 0x00 : 0xFF);
  state_.written = bytes_.size();
  state_.withheld_count = 0;
}

RangeDecoder::RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next_byte();
}

}  // namespace warren
