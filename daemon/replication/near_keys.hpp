// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "daemon/replication/layer_wire.hpp"

namespace warren::replication {

// At least all blocks of a layer within this distance of a point in its frame, along each axis, in
// at most KeySet::kIntervalsMax intervals. Empty if the layer's keys do not reach there.
KeySet near_keys(const Eigen::Vector3d& point_layer, double radius_m, double resolution_m);

// Runs of keys of which something is held though none of them is wanted, the oldest first.
std::vector<KeyInterval> left_behind(const Holdings& held, const KeySet& wanted);

}  // namespace warren::replication
