// SPDX-License-Identifier: Apache-2.0
#include "core/layer/holdings.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace warren {
namespace {

void append(std::vector<Holdings::Interval>& intervals, const Holdings::Interval& next) {
  if (intervals.empty() || intervals.back().held != next.held) intervals.push_back(next);
}

bool raises(const Claim& claim, Revision held) { return claim.from <= held && held < claim.to; }

}  // namespace

std::optional<Holdings> Holdings::from_intervals(std::span<const Interval> intervals) {
  if (intervals.empty() || intervals.size() > kIntervalsMax || intervals[0].first != 0 ||
      intervals.back().first >= kOrdinalEnd) {
    return std::nullopt;
  }
  const auto* const bad = std::adjacent_find(
      intervals.data(), intervals.data() + intervals.size(),
      [](const Interval& a, const Interval& b) { return a.first >= b.first || a.held == b.held; });
  if (bad != intervals.data() + intervals.size()) return std::nullopt;
  Holdings holdings;
  holdings.intervals_.assign(intervals.begin(), intervals.end());
  return holdings;
}

Revision Holdings::at(BlockOrdinal block) const { return intervals_[index_of(block)].held; }

KeyInterval Holdings::interval_around(BlockOrdinal block) const {
  const std::size_t index = index_of(block);
  return {intervals_[index].first, end_of(index)};
}

template <typename Visit>
void Holdings::for_each_held(const KeyInterval& keys, Visit&& visit) const {
  assert(!keys.empty());
  for (std::size_t i = index_of(keys.first); i < intervals_.size(); ++i) {
    if (intervals_[i].first >= keys.end) break;
    visit(intervals_[i].held);
  }
}

Revision Holdings::lowest(const KeyInterval& keys) const {
  Revision lowest = at(keys.first);
  for_each_held(keys, [&](Revision held) { lowest = std::min(lowest, held); });
  return lowest;
}

Revision Holdings::highest(const KeyInterval& keys) const {
  Revision highest = at(keys.first);
  for_each_held(keys, [&](Revision held) { highest = std::max(highest, held); });
  return highest;
}

std::optional<BlockOrdinal> Holdings::first_below(Revision revision) const {
  for (const Interval& interval : intervals_) {
    if (interval.held < revision) return interval.first;
  }
  return std::nullopt;
}

RaiseResult Holdings::judge(const Claim& claim) const {
  bool any_raised = false;
  bool any_gap = false;
  const auto raised = mapped(claim.keys, [&](Revision held) {
    any_raised |= raises(claim, held);
    any_gap |= held < claim.from;
    return raises(claim, held) ? claim.to : held;
  });
  if (!any_raised) return any_gap ? RaiseResult::kGap : RaiseResult::kDuplicate;
  return raised.size() > kIntervalsMax ? RaiseResult::kTooManyIntervals : RaiseResult::kRaised;
}

RaiseResult Holdings::raise(const Claim& claim) {
  const RaiseResult result = judge(claim);
  if (result != RaiseResult::kRaised) return result;
  intervals_ =
      mapped(claim.keys, [&](Revision held) { return raises(claim, held) ? claim.to : held; });
  return result;
}

bool Holdings::forget(const KeyInterval& keys) {
  auto forgotten = mapped(keys, [](Revision) { return Revision{}; });
  if (forgotten.size() > kIntervalsMax) return false;
  intervals_ = std::move(forgotten);
  return true;
}

template <typename NewHeld>
std::vector<Holdings::Interval> Holdings::mapped(const KeyInterval& keys,
                                                 NewHeld&& new_held) const {
  std::vector<Interval> result;
  result.reserve(intervals_.size() + 2);
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    const auto [first, held] = intervals_[i];
    const BlockOrdinal end = end_of(i);
    const BlockOrdinal changed_first = std::max(first, keys.first);
    const BlockOrdinal changed_end = std::min(end, keys.end);
    if (changed_first >= changed_end) {
      append(result, {first, held});
      continue;
    }
    if (first < changed_first) append(result, {first, held});
    append(result, {changed_first, new_held(held)});
    if (changed_end < end) append(result, {changed_end, held});
  }
  return result;
}

std::size_t Holdings::index_of(BlockOrdinal block) const {
  const auto after = std::upper_bound(
      intervals_.begin(), intervals_.end(), block,
      [](BlockOrdinal ordinal, const Interval& interval) { return ordinal < interval.first; });
  return static_cast<std::size_t>(after - intervals_.begin()) - 1;
}

BlockOrdinal Holdings::end_of(std::size_t index) const {
  return index + 1 < intervals_.size() ? intervals_[index + 1].first : kOrdinalEnd;
}

}  // namespace warren
