// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_book.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace warren {
namespace {

using replication::ItemNumber;

bool is_of_one_layer(const NodeStatus& a, const NodeStatus& b) {
  return a.layer && b.layer && a.layer->id == b.layer->id;
}

// Of the layer, and 0: none.
std::uint64_t number_of(const NodeStatus& status) {
  return status.layer ? status.layer->id.number + 1ULL : 0;
}

bool begins_again(const NodeStatus& status, const NodeStatus& before) {
  return status.layer && before.layer && status.layer->id != before.layer->id &&
         number_of(status) <= number_of(before);
}

bool is_later(const NodeBook::Node& node, const LogPlace& place, const NodeStatus& status,
              bool log_is_known) {
  if (node.status.name.empty()) return true;  // nothing was known
  if (node.speaks) return false;
  if (is_of_one_layer(status, node.status)) {
    return status.layer->revision >= node.status.layer->revision;
  }
  if (node.log == place.incarnation) return number_of(status) >= number_of(node.status);
  return log_is_known || status.time_us >= node.status.time_us;
}

bool take(NodeBook::Node& node, const NodeStatus& status) {
  if (status == node.status) return false;
  if (!is_of_one_layer(status, node.status)) node.revisions = {};
  node.status = status;
  if (status.layer) node.revisions.note(status.layer->revision, status.time_us);
  return true;
}

// What was read last of that log before.
std::optional<ItemNumber> note_read(NodeBook::Node& node, const LogPlace& place) {
  const auto found = node.read.find(place.incarnation);
  if (found != node.read.end()) {
    const ItemNumber last = found->second;
    found->second = std::max(last, place.number);
    return last;
  }
  if (node.read.size() < NodeBook::kLogsMax) node.read.emplace(place.incarnation, place.number);
  return std::nullopt;
}

}  // namespace

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

NodeBook::Node* NodeBook::find_or_add(MemberId member) {
  const auto found = nodes_.find(member);
  if (found != nodes_.end()) return &found->second;
  return nodes_.size() < kNodesMax ? &nodes_[member] : nullptr;
}

void NodeBook::on_silent(MemberId member) {
  const auto found = nodes_.find(member);
  if (found != nodes_.end()) found->second.speaks = false;
}

// A node whose layers are numbered anew writes another log, too: the one before has ended.
bool NodeBook::hear(MemberId member, const NodeStatus& status) {
  Node* const node = find_or_add(member);
  if (node == nullptr) return false;
  node->speaks = true;
  if (node->log && begins_again(status, node->status)) {
    node->read[*node->log] = std::numeric_limits<ItemNumber>::max();
    node->log.reset();
  }
  return take(*node, status);
}

bool NodeBook::read(MemberId member, const LogPlace& place, const NodeStatus& status) {
  Node* const node = find_or_add(member);
  if (node == nullptr) return false;
  const auto last = note_read(*node, place);
  if (last && *last >= place.number) return false;
  const bool later = is_later(*node, place, status, last.has_value());
  if (later || is_of_one_layer(status, node->status)) node->log = place.incarnation;
  return later && take(*node, status);
}

const NodeBook::Node* NodeBook::find(MemberId member) const {
  const auto found = nodes_.find(member);
  return found == nodes_.end() ? nullptr : &found->second;
}

}  // namespace warren
