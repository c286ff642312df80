// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_book.hpp"

#include <algorithm>

namespace warren {

void RevisionTimes::note(Revision revision, std::int64_t time_us) {
  if (!times_.empty() && revision <= times_.back().revision) return;
  times_.push_back({revision, time_us});
  if (times_.size() <= kTimesMax) return;
  std::deque<Time> kept;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (i % 2 == 0 || i + 1 == times_.size()) kept.push_back(times_[i]);
  }
  times_ = std::move(kept);
}

std::optional<std::int64_t> RevisionTimes::time_of(Revision revision) const {
  const auto later =
      std::upper_bound(times_.begin(), times_.end(), revision,
                       [](Revision wanted, const Time& time) { return wanted < time.revision; });
  if (later == times_.begin()) return std::nullopt;
  return std::prev(later)->time_us;
}

bool NodeBook::note(MemberId member, const NodeStatus& status) {
  const auto found = nodes_.find(member);
  if (found == nodes_.end()) {
    if (nodes_.size() >= kNodesMax) return false;
    Node& node = nodes_[member];
    node.status = status;
    if (status.layer) node.revisions.note(status.layer->revision, status.time_us);
    return true;
  }
  Node& node = found->second;
  const bool same_layer =
      node.status.layer && status.layer && node.status.layer->id == status.layer->id;
  const bool is_older = same_layer ? status.layer->revision < node.status.layer->revision
                                   : status.time_us < node.status.time_us;
  if (is_older || status == node.status) return false;
  if (!same_layer) node.revisions = {};
  node.status = status;
  if (status.layer) node.revisions.note(status.layer->revision, status.time_us);
  return true;
}

const NodeBook::Node* NodeBook::find(MemberId member) const {
  const auto found = nodes_.find(member);
  return found == nodes_.end() ? nullptr : &found->second;
}

}  // namespace warren
