// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_times.hpp"

#include <algorithm>
#include <iterator>

namespace warren {

Revision MergeTimes::note(Revision revision, std::int64_t fleet_time_ns) {
  Revision before;
  if (const auto next = times_.lower_bound(revision); next != times_.begin()) {
    before = std::prev(next)->first;
  }
  if (revision > latest_) {
    latest_ = revision;
    latest_ns_ = fleet_time_ns;
  } else if (revision == latest_) {
    latest_ns_ = std::max(latest_ns_, fleet_time_ns);
  }
  if (!keeps(revision)) return before;
  auto& time = times_.try_emplace(revision, fleet_time_ns).first->second;
  time = std::max(time, fleet_time_ns);
  if (times_.size() <= kTimesMax) return before;
  while (times_.size() > kTimesMax) {
    stride_ *= 2;
    std::erase_if(times_, [this](const auto& entry) { return !keeps(entry.first); });
  }
  return Revision{};
}

std::int64_t MergeTimes::time_ns(Revision revision) const {
  const auto kept = times_.lower_bound(revision);
  return kept != times_.end() ? kept->second : latest_ns_;
}

}  // namespace warren
