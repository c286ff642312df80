// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace warren {

// Probability that a bit is set, of 65536. Precondition wherever one is used: not 0.
using Probability = std::uint16_t;
inline constexpr Probability kEvenOdds = 32768;

// Follows what was seen. Never reaches 0 nor certainty: it stops 15 short of either.
constexpr void adapt(Probability& probability, bool bit) {
  constexpr int kRate = 4;
  probability = static_cast<Probability>(bit ? probability + ((65536 - probability) >> kRate)
                                             : probability - (probability >> kRate));
}

inline constexpr std::uint32_t kRangeMin = 1U << 24;

constexpr std::uint32_t share_of(std::uint32_t range, Probability probability) {
  return (range >> 16) * probability;
}

// A binary range coder (G. N. N. Martin, 1979) in integers, whose state can be put back to an
// earlier one.
class RangeEncoder {
 public:
  struct State {
    std::uint64_t low = 0;  // 32 bits and a carry
    std::uint32_t range = 0xFFFFFFFFU;
    std::uint8_t withheld = 0;       // a byte that a carry may still reach
    std::size_t withheld_count = 0;  // it, and the bytes of ones behind it
    std::size_t written = 0;
  };

  void encode(bool bit, Probability probability);
  std::size_t bytes_if_finished() const { return state_.written + state_.withheld_count + 1; }

  const State& state() const { return state_; }
  // Undoes what was encoded since `state` was read.
  void rewind(const State& state);

  // Appends the rest; the encoder is spent.
  std::vector<std::uint8_t> finish();

 private:
  void shift_byte_out();
  void release_withheld();

  State state_;
  std::vector<std::uint8_t> bytes_;
};

// Reads what RangeEncoder wrote. Past the end it reads zeros and goes on: the caller asks
// overrun() often enough to stop in bounded time, and finished() at the end.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> bytes);

  bool decode(Probability probability);
  // More was read than any encoder would have left to be read as zeros.
  bool overrun() const { return read_ > bytes_.size() + kImpliedZeros; }
  // All bytes, and no more, were needed.
  bool finished() const { return read_ == bytes_.size() + kImpliedZeros; }

 private:
  static constexpr std::size_t kImpliedZeros = 3;

  std::uint8_t next_byte();

  std::span<const std::uint8_t> bytes_;
  std::size_t read_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFU;
  std::uint32_t code_ = 0;
};

inline void RangeEncoder::encode(bool bit, Probability probability) {
  assert(probability != 0);
  const std::uint32_t share = share_of(state_.range, probability);
  if (bit) {
    state_.range = share;
  } else {
    state_.low += share;
    state_.range -= share;
  }
  while (state_.range < kRangeMin) {
    state_.range <<= 8;
    shift_byte_out();
  }
}

inline bool RangeDecoder::decode(Probability probability) {
  assert(probability != 0);
  const std::uint32_t share = share_of(range_, probability);
  const bool bit = code_ < share;
  if (bit) {
    range_ = share;
  } else {
    code_ -= share;
    range_ -= share;
  }
  while (range_ < kRangeMin) {
    range_ <<= 8;
    code_ = code_ << 8 | next_byte();
  }
  return bit;
}

inline std::uint8_t RangeDecoder::next_byte() {
  const std::uint8_t byte = read_ < bytes_.size() ? bytes_[read_] : std::uint8_t{0};
  ++read_;
  return byte;
}

}  // namespace warren
