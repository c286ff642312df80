// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/wire/frames.hpp"

namespace warren::mesh {

// A set of numbers as ranges: in order, not empty, not touching.
class ByteRanges {
 public:
  void add(NumberRange range);
  void remove(NumberRange range);
  bool contains(NumberRange range) const;
  bool contains(std::uint64_t number) const { return contains({number, number + 1}); }
  // The parts of `range` that are not in the set.
  ByteRanges missing_in(NumberRange range) const;

  bool empty() const { return ranges_.empty(); }
  void clear() { ranges_.clear(); }
  std::uint64_t size() const;  // numbers in the set
  std::span<const NumberRange> ranges() const { return ranges_; }
  friend bool operator==(const ByteRanges&, const ByteRanges&) = default;

 private:
  std::vector<NumberRange> ranges_;
};

}  // namespace warren::mesh
