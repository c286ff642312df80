// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/voxel/scan.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// One layer's map with the place of its keys: what the exporters write.
struct MapSnapshot {
  LayerOrigin origin;
  SelfMap voxels;
};

}  // namespace warren
