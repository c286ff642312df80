// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_frame.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

namespace warren {
namespace {

// Half a step of float32 (2^-25 of the value) is 1 % of a voxel at this many voxels.
constexpr std::int64_t kMaxFloatVoxels = 1 << 18;

bool fits(const MapSnapshot& map, std::int64_t low, std::int64_t high) {
  const auto bounds = map.voxels.bounds();
  if (!bounds) return true;
  const auto axis_fits = [&](std::int64_t origin, std::int32_t key_low, std::int32_t key_high) {
    return origin + key_low >= low && origin + key_high <= high;
  };
  return axis_fits(map.origin.x, bounds->low.x, bounds->high.x) &&
         axis_fits(map.origin.y, bounds->low.y, bounds->high.y) &&
         axis_fits(map.origin.z, bounds->low.z, bounds->high.z);
}

FileFrame layer_frame(const MapSnapshot& map, const char* why) {
  const Eigen::Vector3d origin = map.origin.position_map(map.voxels.lattice().resolution_m());
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "layer frame (%s): add %.3f %.3f %.3f m to its coordinates for the map frame", why,
                origin.x(), origin.y(), origin.z());
  return {LayerOrigin{}, text.data()};
}

}  // namespace

FileFrame frame_for_tree(const MapSnapshot& map) {
  if (fits(map, kKeyMin, kKeyMax)) return {map.origin, ""};
  return layer_frame(map, "the map frame is outside OctoMap's key space");
}

FileFrame frame_for_cloud(const MapSnapshot& map) {
  if (fits(map, -kMaxFloatVoxels, kMaxFloatVoxels)) return {map.origin, ""};
  return layer_frame(map, "the map frame is too far from zero for float32");
}

}  // namespace warren
