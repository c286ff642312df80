// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "core/layer/holdings.hpp"
#include "daemon/replication/layer_wire.hpp"

namespace warren::replication {

// Calls visit(KeyInterval, Revision of a, Revision of b) for the pieces of `keys`, in order, in
// which both hold one revision, as long as it returns true.
template <typename Visit>
void for_each_piece(const KeyInterval& keys, const Holdings& a, const Holdings& b, Visit&& visit) {
  KeyInterval piece = keys;
  while (piece.first < keys.end) {
    piece.end = std::min(
        {keys.end, a.interval_around(piece.first).end, b.interval_around(piece.first).end});
    if (!visit(piece, a.at(piece.first), b.at(piece.first))) return;
    piece.first = piece.end;
  }
}

// Whether somewhere in these keys `a` holds more than `b`.
inline bool holds_more(const Holdings& a, const Holdings& b, const KeySet& keys = {}) {
  bool more = false;
  for (const KeyInterval& interval : keys.intervals) {
    for_each_piece(interval, a, b, [&](const KeyInterval&, Revision in_a, Revision in_b) {
      more = in_a > in_b;
      return !more;
    });
    if (more) return true;
  }
  return false;
}

// Everywhere the higher of both; `a` alone if that takes more intervals than holdings may have.
inline Holdings higher_of(const Holdings& a, const Holdings& b) {
  std::vector<Holdings::Interval> intervals;
  for_each_piece({}, a, b, [&](const KeyInterval& piece, Revision in_a, Revision in_b) {
    const Revision held = std::max(in_a, in_b);
    if (intervals.empty() || intervals.back().held != held) {
      intervals.push_back({piece.first, held});
    }
    return true;
  });
  return Holdings::from_intervals(intervals).value_or(a);
}

// The same in at most `most` intervals: of neighbours that are joined the lower counts.
inline Holdings coarsened(const Holdings& holdings, std::size_t most) {
  const auto all = holdings.intervals();
  const std::size_t joined = (all.size() + most - 1) / most;
  std::vector<Holdings::Interval> intervals;
  for (std::size_t i = 0; i < all.size(); i += joined) {
    Revision lowest = all[i].held;
    for (std::size_t k = i; k < std::min(i + joined, all.size()); ++k) {
      lowest = std::min(lowest, all[k].held);
    }
    if (intervals.empty() || intervals.back().held != lowest) {
      intervals.push_back({all[i].first, lowest});
    }
  }
  return *Holdings::from_intervals(intervals);
}

}  // namespace warren::replication
