// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "daemon/fleet/node_status.hpp"
#include "transport/mesh_id.hpp"

namespace warren {

// When the writer of a layer made its revisions, by its own clock, as far as it was told: thinned
// where it would take too much.
class RevisionTimes {
 public:
  static constexpr std::size_t kTimesMax = 256;

  // Ignores what is not newer than all it knows.
  void note(Revision revision, std::int64_t time_us);
  // Of the latest revision known up to this one.
  std::optional<std::int64_t> time_of(Revision revision) const;

 private:
  struct Time {
    Revision revision;
    std::int64_t time_us = 0;
  };
  std::deque<Time> times_;  // ascending
};

// What is known of the nodes of the fleet by their own word, whatever way it came. At most so many.
class NodeBook {
 public:
  static constexpr std::size_t kNodesMax = 256;

  struct Node {
    NodeStatus status;        // the latest
    RevisionTimes revisions;  // of its present layer
  };

  // True if it was news. An older word than the last of a layer changes nothing.
  bool note(MemberId member, const NodeStatus& status);
  const Node* find(MemberId member) const;
  const std::map<MemberId, Node>& nodes() const { return nodes_; }

 private:
  std::map<MemberId, Node> nodes_;
};

}  // namespace warren
