// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/ray_cast.hpp"

#include "core/voxel/self_map.hpp"

namespace warren {

std::optional<RayHit> SelfMap::cast_ray(const RayQuery& query) const {
  return warren::cast_ray(lattice_, query,
                          [this](const VoxelKey& key) { return store_.state(key); });
}

}  // namespace warren
