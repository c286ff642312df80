// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "daemon/fleet/node_status.hpp"
#include "transport/mesh_time.hpp"

namespace warren {

// When a node's status is worth telling: to neighbours whenever something but its time changed, to
// the whole fleet likewise, but not too often. Nothing is told while nothing changes.
class OwnWord {
 public:
  static constexpr Duration kItemEvery = std::chrono::seconds(10);
  static constexpr float kMoved_m = 1.0F;

  struct Tell {
    bool neighbours = false;
    bool fleet = false;
  };
  // `last`: this may be the last word for long, so the fleet is told what it was not told yet.
  Tell judge(MeshTime now, const NodeStatus& status, bool last = false);

 private:
  static bool differs(const std::optional<NodeStatus>& told, const NodeStatus& status);

  std::optional<NodeStatus> told_neighbours_;
  std::optional<NodeStatus> told_fleet_;
  MeshTime told_fleet_at_{};
};

}  // namespace warren
