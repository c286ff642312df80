// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "core/voxel/self_map.hpp"
#include "core/voxel/voxel_ray.hpp"

namespace warren {
std::optional<RayHit> SelfMap::cast_ray(const RayQuery& query) const {
  const auto start = lattice_.key_of(query.origin_layer);
  const std::array<double, 3> direction = {query.direction_layer.x, query.direction_layer.y,
                                           query.direction_layer.z};
  const double norm = std::hypot(direction[0], direction[1], direction[2]);
  if (!start || !std::isfinite(norm) || norm == 0.0) return std::nullopt;
  const std::array<double, 3> origin = {query.origin_layer.x, query.origin_layer.y,
                                        query.origin_layer.z};
  VoxelRay ray(lattice_, *start, origin,
               {direction[0] / norm, direction[1] / norm, direction[2] / norm});
  for (; ray.entered_m() <= query.max_range_m && ray.in_key_space(); ray.advance()) {
    const VoxelState found = store_.state(ray.key());
    const bool stops =
        found == VoxelState::kOccupied || (found == VoxelState::kUnknown && query.unknown_stops);
    if (stops) return RayHit{ray.key(), found, ray.entered_m()};
  }
  return std::nullopt;
}

}  // namespace warren
