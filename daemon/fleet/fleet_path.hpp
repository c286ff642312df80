// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/fleet/operator_orders.hpp"
#include "daemon/replication/replication.hpp"

namespace warren {

// Where a node's sensor was, thinned, in the fleet frame: where its layers lie by now.
struct FleetPath {
  static constexpr std::size_t kPointsMax = 16384;

  struct Point {
    std::int64_t time_us = 0;  // since 1970, by the node's clock
    LayerId layer;
    Eigen::Vector3d position_fleet = Eigen::Vector3d::Zero();
  };
  std::vector<Point> points;   // oldest first
  std::uint64_t unplaced = 0;  // points in layers of which it is not known yet where they lie
  bool more = false;           // after these, later ones
};

// What the logs have of this node, of the points later than `after_us` the first kPointsMax.
FleetPath path_of(replication::Replication& replication, const OperatorOrders& orders,
                  MemberId node, std::int64_t after_us);
// The number after all parts of the path in this layer that this node's own log has.
std::uint32_t next_path_number(replication::LogBook& book, const LayerId& layer);

}  // namespace warren
