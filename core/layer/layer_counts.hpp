// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// The known voxels of a layer, and the blocks that hold any.
MapCounts counts_of(const Replica& layer);

}  // namespace warren
