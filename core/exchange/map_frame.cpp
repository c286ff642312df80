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

bool fits(const MapPlace& place, std::int64_t low, std::int64_t high) {
  if (!place.bounds) return true;
  const auto axis_fits = [&](std::int64_t origin, std::int32_t key_low, std::int32_t key_high) {
    return origin + key_low >= low && origin + key_high <= high;
  };
  return axis_fits(place.origin.x, place.bounds->low.x, place.bounds->high.x) &&
         axis_fits(place.origin.y, place.bounds->low.y, place.bounds->high.y) &&
         axis_fits(place.origin.z, place.bounds->low.z, place.bounds->high.z);
}

FileFrame layer_frame(const MapPlace& place, const char* why) {
  const Eigen::Vector3d origin = place.origin.position_map(place.resolution_m);
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "layer frame (%s): add %.3f %.3f %.3f m to its coordinates for the map frame", why,
                origin.x(), origin.y(), origin.z());
  return {LayerOrigin{}, text.data()};
}

}  // namespace

MapPlace place_of(const MapSnapshot& map) {
  return {map.origin, map.voxels.bounds(), map.voxels.lattice().resolution_m()};
}

MapPlace place_of(const MergedSnapshot& map) {
  return {map.origin(), map.bounds(), map.resolution_m()};
}

FileFrame frame_for_tree(const MapPlace& place) {
  if (fits(place, kKeyMin, kKeyMax)) return {place.origin, ""};
  return layer_frame(place, "the map frame is outside OctoMap's key space");
}

FileFrame frame_for_cloud(const MapPlace& place) {
  if (fits(place, -kMaxFloatVoxels, kMaxFloatVoxels)) return {place.origin, ""};
  return layer_frame(place, "the map frame is too far from zero for float32");
}

}  // namespace warren
