// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/layer/diff_contexts.hpp"
#include "core/layer/range_coder.hpp"

namespace warren {

// The adaptive bits of a packet on their way out. It and ModelDecoder offer the same calls, so that
// one walk over the data serves both: here the argument is written and returned, there it is
// ignored and what was read is returned.
class ModelEncoder {
 public:
  static constexpr bool kReads = false;

  explicit ModelEncoder(const DiffPriors& priors) : probabilities_(priors) {}

  bool bit(std::size_t context, bool value) {
    Probability& probability = probabilities_[context];
    journal_.emplace_back(static_cast<std::uint32_t>(context), probability);
    range_.encode(value, probability);
    adapt(probability, value);
    return value;
  }
  bool even_bit(bool value) {
    range_.encode(value, kEvenOdds);
    return value;
  }
  bool overrun() const { return false; }

  // From here on undo() goes back to this point.
  void mark() {
    marked_ = range_.state();
    journal_.clear();
  }
  void undo() {
    for (; !journal_.empty(); journal_.pop_back()) {
      probabilities_[journal_.back().first] = journal_.back().second;
    }
    range_.rewind(marked_);
  }

  std::size_t bytes_if_finished() const { return range_.bytes_if_finished(); }
  std::vector<std::uint8_t> finish() { return range_.finish(); }

 private:
  DiffPriors probabilities_;
  RangeEncoder range_;
  RangeEncoder::State marked_;
  std::vector<std::pair<std::uint32_t, Probability>> journal_;
};

class ModelDecoder {
 public:
  static constexpr bool kReads = true;

  ModelDecoder(const DiffPriors& priors, std::span<const std::uint8_t> bytes)
      : probabilities_(priors), range_(bytes) {}

  bool bit(std::size_t context, bool /*value*/) {
    Probability& probability = probabilities_[context];
    const bool value = range_.decode(probability);
    adapt(probability, value);
    return value;
  }
  bool even_bit(bool /*value*/) { return range_.decode(kEvenOdds); }
  bool overrun() const { return range_.overrun(); }
  bool finished() const { return range_.finished(); }

 private:
  DiffPriors probabilities_;
  RangeDecoder range_;
};

// `bits` bits, highest first, each with the ones before it as context; takes 2^bits contexts.
template <typename Coder>
std::uint32_t code_tree(Coder& coder, std::size_t first_context, int bits, std::uint32_t value) {
  std::uint32_t node = 1;
  for (int i = bits - 1; i >= 0; --i) {
    node = node << 1 | (coder.bit(first_context + node, (value >> i & 1) != 0) ? 1U : 0U);
  }
  return node - (1U << bits);
}

// A number of less than 2^63: its length by a tree of diff_context::kNumberBits, then its bits
// below the highest.
template <typename Coder>
std::uint64_t code_number(Coder& coder, std::size_t first_context, std::uint64_t value) {
  const auto length = static_cast<int>(
      code_tree(coder, first_context, 6, static_cast<std::uint32_t>(std::bit_width(value))));
  if (length == 0) return 0;
  std::uint64_t read = 1;
  for (int i = length - 2; i >= 0; --i) {
    read = read << 1 | (coder.even_bit((value >> i & 1) != 0) ? 1U : 0U);
  }
  return read;
}

}  // namespace warren
