// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/near_keys.hpp"

#include <algorithm>
#include <cmath>

#include "core/voxel/key.hpp"

namespace warren::replication {
namespace {

constexpr int kCubesPerAxisMax = 8;

struct Bounds {
  std::int32_t low = 0;
  std::int32_t high = 0;  // included
};

// Block coordinates along one axis; nothing if they lie beyond the key space.
std::optional<Bounds> bounds_of(double centre_m, double radius_m, double block_m) {
  const double low = std::floor((centre_m - radius_m) / block_m);
  const double high = std::floor((centre_m + radius_m) / block_m);
  constexpr std::int32_t kLeast = kKeyMin / kBlockEdge;
  constexpr std::int32_t kMost = kKeyMax / kBlockEdge;
  const double least = kLeast;
  const double most = kMost;
  if (!(low <= most && high >= least)) return std::nullopt;
  return Bounds{static_cast<std::int32_t>(std::max(low, least)),
                static_cast<std::int32_t>(std::min(high, most))};
}

// Cubes of 2^level blocks per edge are intervals of keys.
std::vector<KeyInterval> cubes(const Bounds& x, const Bounds& y, const Bounds& z, int level) {
  std::vector<KeyInterval> intervals;
  const BlockOrdinal length = BlockOrdinal{1} << 3 * level;
  for (std::int32_t i = x.low >> level; i <= x.high >> level; ++i) {
    for (std::int32_t j = y.low >> level; j <= y.high >> level; ++j) {
      for (std::int32_t k = z.low >> level; k <= z.high >> level; ++k) {
        const BlockOrdinal first =
            ordinal_of({i * (1 << level), j * (1 << level), k * (1 << level)});
        intervals.push_back({first, first + length});
      }
    }
  }
  return intervals;
}

bool fits(const Bounds& bounds, int level) {
  return (bounds.high >> level) - (bounds.low >> level) < kCubesPerAxisMax;
}

void join_touching(std::vector<KeyInterval>& intervals) {
  std::vector<KeyInterval> joined;
  for (const KeyInterval& next : intervals) {
    if (!joined.empty() && joined.back().end == next.first) {
      joined.back().end = next.end;
    } else {
      joined.push_back(next);
    }
  }
  intervals = std::move(joined);
}

// Closes the gap that brings in the fewest keys.
void close_smallest_gap(std::vector<KeyInterval>& intervals) {
  std::size_t best = 1;
  const auto gap = [&](std::size_t i) { return intervals[i].first - intervals[i - 1].end; };
  for (std::size_t i = 2; i < intervals.size(); ++i) {
    if (gap(i) < gap(best)) best = i;
  }
  intervals[best - 1].end = intervals[best].end;
  intervals.erase(intervals.begin() + static_cast<std::ptrdiff_t>(best));
}

// The keys between those of a set.
std::vector<KeyInterval> others_than(const KeySet& keys) {
  std::vector<KeyInterval> others;
  BlockOrdinal first = 0;
  for (const KeyInterval& interval : keys.intervals) {
    if (first < interval.first) others.push_back({first, interval.first});
    first = interval.end;
  }
  if (first < KeyInterval{}.end) others.push_back({first, KeyInterval{}.end});
  return others;
}

struct Run {
  KeyInterval keys;
  Revision highest;
};

void append_runs(std::vector<Run>& runs, const Holdings& held, const KeyInterval& keys) {
  for (BlockOrdinal at = keys.first; at < keys.end;) {
    const KeyInterval piece{at, std::min(held.interval_around(at).end, keys.end)};
    const Revision revision = held.at(at);
    at = piece.end;
    if (revision == Revision{}) continue;
    if (!runs.empty() && runs.back().keys.end == piece.first && piece.first > keys.first) {
      runs.back() = {{runs.back().keys.first, piece.end}, std::max(runs.back().highest, revision)};
    } else {
      runs.push_back({piece, revision});
    }
  }
}

}  // namespace

std::vector<KeyInterval> left_behind(const Holdings& held, const KeySet& wanted) {
  std::vector<Run> runs;
  for (const KeyInterval& keys : others_than(wanted)) append_runs(runs, held, keys);
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.highest < b.highest; });
  std::vector<KeyInterval> keys;
  keys.reserve(runs.size());
  for (const Run& run : runs) keys.push_back(run.keys);
  return keys;
}

KeySet near_keys(const Eigen::Vector3d& point_layer, double radius_m, double resolution_m) {
  const double block_m = resolution_m * kBlockEdge;
  const auto x = bounds_of(point_layer.x(), radius_m, block_m);
  const auto y = bounds_of(point_layer.y(), radius_m, block_m);
  const auto z = bounds_of(point_layer.z(), radius_m, block_m);
  KeySet keys;
  keys.intervals.clear();
  if (!x || !y || !z) return keys;
  int level = 0;
  while (!fits(*x, level) || !fits(*y, level) || !fits(*z, level)) ++level;
  keys.intervals = cubes(*x, *y, *z, level);
  std::sort(keys.intervals.begin(), keys.intervals.end(),
            [](const KeyInterval& a, const KeyInterval& b) { return a.first < b.first; });
  join_touching(keys.intervals);
  while (keys.intervals.size() > KeySet::kIntervalsMax) close_smallest_gap(keys.intervals);
  return keys;
}

}  // namespace warren::replication
