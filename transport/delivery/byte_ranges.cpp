// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/byte_ranges.hpp"

#include <algorithm>

namespace warren::mesh {

void ByteRanges::add(NumberRange range) {
  if (range.first >= range.end) return;
  const auto first = std::lower_bound(
      ranges_.begin(), ranges_.end(), range.first,
      [](const NumberRange& held, std::uint64_t number) { return held.end < number; });
  auto last = first;
  for (; last != ranges_.end() && last->first <= range.end; ++last) {
    range.first = std::min(range.first, last->first);
    range.end = std::max(range.end, last->end);
  }
  if (first == last) {
    ranges_.insert(first, range);
  } else {
    *first = range;
    ranges_.erase(first + 1, last);
  }
}

void ByteRanges::remove(NumberRange range) {
  if (range.first >= range.end) return;
  const auto first = std::upper_bound(
      ranges_.begin(), ranges_.end(), range.first,
      [](std::uint64_t number, const NumberRange& held) { return number < held.end; });
  auto last = first;
  std::vector<NumberRange> left;
  for (; last != ranges_.end() && last->first < range.end; ++last) {
    if (last->first < range.first) left.push_back({last->first, range.first});
    if (last->end > range.end) left.push_back({range.end, last->end});
  }
  ranges_.insert(ranges_.erase(first, last), left.begin(), left.end());
}

bool ByteRanges::contains(NumberRange range) const {
  if (range.first >= range.end) return true;
  const auto found = std::upper_bound(
      ranges_.begin(), ranges_.end(), range.first,
      [](std::uint64_t number, const NumberRange& held) { return number < held.end; });
  return found != ranges_.end() && found->first <= range.first && range.end <= found->end;
}

ByteRanges ByteRanges::missing_in(NumberRange range) const {
  ByteRanges missing;
  missing.add(range);
  for (const NumberRange& held : ranges_) missing.remove(held);
  return missing;
}

std::uint64_t ByteRanges::size() const {
  std::uint64_t numbers = 0;
  for (const NumberRange& range : ranges_) numbers += range.end - range.first;
  return numbers;
}

}  // namespace warren::mesh
