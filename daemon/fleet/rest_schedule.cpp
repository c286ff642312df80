// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/rest_schedule.hpp"

namespace warren {

Revision RestSchedule::tick(Revision now) {
  constexpr std::uint64_t kMarksPerWait = 8;
  const std::uint64_t step = (after_ticks_ + kMarksPerWait - 1) / kMarksPerWait;
  ++ticks_;
  if (marks_.empty() || ticks_ - marks_.back().tick >= step) marks_.push_back({ticks_, now});
  const auto is_due = [&](const Mark& mark) { return ticks_ - mark.tick >= after_ticks_; };
  while (marks_.size() > 1 && is_due(marks_[1])) marks_.pop_front();
  return is_due(marks_.front()) ? marks_.front().revision : Revision{};
}

std::size_t rest_quiet_regions(Replica& layer, RestSchedule& schedule, std::size_t most) {
  const Revision until = schedule.tick(layer.holdings().highest({}));
  if (most == 0 || until == Revision{} || layer.regions_awake() == 0) return 0;
  return layer.rest(until, most);
}

}  // namespace warren
