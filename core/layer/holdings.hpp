// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/layer/claim.hpp"

namespace warren {

enum class RaiseResult : std::uint8_t { kRaised, kDuplicate, kGap, kTooManyIntervals };

// Which revision of a layer is held for each block. Invariants: the intervals cover the whole key
// space, neighbours differ, there are at most kIntervalsMax; no revision goes down, except to 0 by
// forget().
class Holdings {
 public:
  static constexpr std::size_t kIntervalsMax = 64;

  // From this block on, up to the next interval's first, this revision is held.
  struct Interval {
    BlockOrdinal first = 0;
    Revision held;
    friend bool operator==(const Interval&, const Interval&) = default;
  };

  // Holds `held` everywhere.
  explicit Holdings(Revision held = {}) : intervals_{{0, held}} {}
  // Nothing if the intervals break an invariant: what a store or a peer says is not trusted.
  static std::optional<Holdings> from_intervals(std::span<const Interval> intervals);

  Revision at(BlockOrdinal block) const;
  // The interval around this block.
  KeyInterval interval_around(BlockOrdinal block) const;
  // Precondition for both: keys are not empty.
  Revision lowest(const KeyInterval& keys) const;
  Revision highest(const KeyInterval& keys) const;
  // Lowest key where less than `revision` is held: where a sweep that stopped goes on.
  std::optional<BlockOrdinal> first_below(Revision revision) const;

  // What raise(claim) would return; changes nothing.
  RaiseResult judge(const Claim& claim) const;
  // Where from <= held < to, held becomes to. Changes nothing unless it returns kRaised.
  RaiseResult raise(const Claim& claim);
  // Held becomes 0; false, and nothing changes, if that made too many intervals.
  bool forget(const KeyInterval& keys);

  std::span<const Interval> intervals() const { return intervals_; }
  friend bool operator==(const Holdings&, const Holdings&) = default;

 private:
  template <typename Visit>
  void for_each_held(const KeyInterval& keys, Visit&& visit) const;
  template <typename NewHeld>
  std::vector<Interval> mapped(const KeyInterval& keys, NewHeld&& new_held) const;
  std::size_t index_of(BlockOrdinal block) const;
  BlockOrdinal end_of(std::size_t index) const;

  std::vector<Interval> intervals_;
};

}  // namespace warren
