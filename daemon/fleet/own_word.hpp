// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "daemon/fleet/node_status.hpp"
#include "transport/mesh_time.hpp"

namespace warren {

// When a node's status is worth telling: at once who it is, what layer it writes, and what stands
// still after it changed; what changes with every tick now and then, as each neighbour is told in a
// packet of its own. The whole fleet hears of it still less often. Nothing is told while nothing
// but the time changes.
class OwnWord {
 public:
  static constexpr Duration kEveryMax = std::chrono::seconds(5);
  static constexpr int kEveryTicks = 5;
  static constexpr int kStillTicks = 2;
  static constexpr Duration kItemEvery = std::chrono::seconds(10);
  static constexpr float kMoved_m = 1.0F;

  explicit OwnWord(Duration tick) : tick_(tick) {}

  struct Tell {
    bool neighbours = false;
    bool fleet = false;
  };
  // `last`: this may be the last word for long, so the fleet is told what it was not told yet.
  Tell judge(MeshTime now, const NodeStatus& status, bool last = false);

 private:
  static bool differs(const std::optional<NodeStatus>& told, const NodeStatus& status);
  bool cannot_wait(MeshTime now, const NodeStatus& status) const;

  Duration tick_;
  std::optional<NodeStatus> previous_;
  MeshTime changed_{};
  std::optional<NodeStatus> told_neighbours_;
  MeshTime told_neighbours_at_{};
  std::optional<NodeStatus> told_fleet_;
  MeshTime told_fleet_at_{};
};

}  // namespace warren
