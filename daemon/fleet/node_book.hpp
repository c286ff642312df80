// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "daemon/fleet/node_status.hpp"
#include "daemon/replication/item.hpp"
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

// Where a status stands among the items of its writer.
struct LogPlace {
  std::uint64_t incarnation = 0;  // of the log
  replication::ItemNumber number = 0;
};

// What is known of the nodes of the fleet by their own word, whatever way it came. At most so many.
// Which of two words is the later one is no matter of clocks, as far as that can be: a robot may
// have none that outlives a reboot.
class NodeBook {
 public:
  static constexpr std::size_t kNodesMax = 256;
  // A node begins a log when it loses its store. Of further ones the clock decides.
  static constexpr std::size_t kLogsMax = 16;

  struct Node {
    NodeStatus status;                 // the latest
    RevisionTimes revisions;           // of its present layer
    bool speaks = false;               // it is heard itself
    std::optional<std::uint64_t> log;  // that it writes in the life of that status, if known
    std::map<std::uint64_t, replication::ItemNumber> read;  // the latest status of each log
  };

  // All give true if it was news. What a node says itself, in its present boot, counts.
  bool hear(MemberId member, const NodeStatus& status);
  // It is not heard any more: from now on its log counts.
  void on_silent(MemberId member);
  // Out of its log. An older word than the last changes nothing: of a layer its revision tells; of
  // a log the number of the layer. Of two logs the first word is judged by its time, and a log that
  // goes on after that is the living one.
  bool read(MemberId member, const LogPlace& place, const NodeStatus& status);
  const Node* find(MemberId member) const;
  const std::map<MemberId, Node>& nodes() const { return nodes_; }

 private:
  Node* find_or_add(MemberId member);

  std::map<MemberId, Node> nodes_;
};

}  // namespace warren
