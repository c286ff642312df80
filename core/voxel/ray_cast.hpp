// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/voxel/block_store.hpp"
#include "core/voxel/voxel_ray.hpp"

namespace warren {

struct RayHit {
  VoxelKey key;
  VoxelState state = VoxelState::kUnknown;  // occupied; or unknown, if such stops the ray
  double range_m = 0.0;                     // from the origin to where the ray enters the voxel
};

struct RayQuery {
  Point3f origin_layer;
  Point3f direction_layer;  // any length but zero
  double max_range_m = 0.0;
  bool unknown_stops = true;
};

// First voxel along the ray that is occupied (or unknown), by state_of(key); nothing when there is
// none in range. The voxel of the origin itself is looked at too.
template <typename StateOf>
std::optional<RayHit> cast_ray(const Lattice& lattice, const RayQuery& query, StateOf&& state_of) {
  const auto start = lattice.key_of(query.origin_layer);
  const std::array<double, 3> direction = {query.direction_layer.x, query.direction_layer.y,
                                           query.direction_layer.z};
  const double norm = std::hypot(direction[0], direction[1], direction[2]);
  if (!start || !std::isfinite(norm) || norm == 0.0) return std::nullopt;
  const std::array<double, 3> origin = {query.origin_layer.x, query.origin_layer.y,
                                        query.origin_layer.z};
  VoxelRay ray(lattice, *start, origin,
               {direction[0] / norm, direction[1] / norm, direction[2] / norm});
  for (; ray.entered_m() <= query.max_range_m && ray.in_key_space(); ray.advance()) {
    const VoxelState found = state_of(ray.key());
    const bool stops =
        found == VoxelState::kOccupied || (found == VoxelState::kUnknown && query.unknown_stops);
    if (stops) return RayHit{ray.key(), found, ray.entered_m()};
  }
  return std::nullopt;
}

}  // namespace warren
