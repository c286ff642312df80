// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "core/layer/replica.hpp"

namespace warren {

// What it takes to ask for the voxel at a point, CPU of one thread.
struct QueryCost {
  double ours_ns = 0.0;
  double octomap_ns = 0.0;
  double known_share = 0.0;  // of the points, in both
};

// The merge-map of four overlapping quarters of the layer, one of them moved and turned, beside an
// OctoMap of the same voxels, at the same random points in the map's bounds. Nothing if the two do
// not agree at every point, or nothing is known.
std::optional<QueryCost> bench_query(const Replica& layer, double resolution_m);

}  // namespace warren
