// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>

#include "core/voxel/point.hpp"

namespace warren {

// Keys count voxels of the layer's lattice from the layer's origin, floor(coordinate / resolution)
// per axis. The space is OctoMap's: 16 bits per axis.
inline constexpr std::int32_t kKeyMin = -32768;
inline constexpr std::int32_t kKeyMax = 32767;
inline constexpr std::int32_t kBlockEdge = 8;    // voxels
inline constexpr std::int32_t kRegionEdge = 64;  // voxels

struct VoxelKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const VoxelKey&, const VoxelKey&) = default;
};

// A block is 8x8x8 voxels; its key is the voxel key divided by 8, rounded down.
struct BlockKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const BlockKey&, const BlockKey&) = default;
};

constexpr BlockKey block_of(const VoxelKey& key) { return {key.x >> 3, key.y >> 3, key.z >> 3}; }
constexpr VoxelKey first_voxel_of(const BlockKey& key) {
  return {key.x * kBlockEdge, key.y * kBlockEdge, key.z * kBlockEdge};
}

// Both corners belong to the box.
struct KeyBox {
  VoxelKey low{kKeyMin, kKeyMin, kKeyMin};
  VoxelKey high{kKeyMax, kKeyMax, kKeyMax};

  constexpr bool contains(const VoxelKey& key) const {
    return key.x >= low.x && key.x <= high.x && key.y >= low.y && key.y <= high.y &&
           key.z >= low.z && key.z <= high.z;
  }
};

// Metres to keys and back, by the same arithmetic as octomap::OcTree: a point on a voxel border
// must fall on the same side in both.
class Lattice {
 public:
  explicit Lattice(double resolution_m)
      : resolution_m_(resolution_m), per_metre_(1.0 / resolution_m) {}

  double resolution_m() const { return resolution_m_; }

  // Nothing when the point lies outside the key space or is not finite.
  std::optional<VoxelKey> key_of(double x_m, double y_m, double z_m) const {
    const double x = per_metre_ * x_m;
    const double y = per_metre_ * y_m;
    const double z = per_metre_ * z_m;
    if (!in_key_space(x) || !in_key_space(y) || !in_key_space(z)) return std::nullopt;
    return VoxelKey{floor_to_key(x), floor_to_key(y), floor_to_key(z)};
  }
  std::optional<VoxelKey> key_of(const Point3f& p) const { return key_of(p.x, p.y, p.z); }

  // Centre of the voxel along one axis, metres.
  double centre_m(std::int32_t key) const { return (key + 0.5) * resolution_m_; }
  Point3f centre(const VoxelKey& key) const {
    return {static_cast<float>(centre_m(key.x)), static_cast<float>(centre_m(key.y)),
            static_cast<float>(centre_m(key.z))};
  }

 private:
  static bool in_key_space(double key) { return key >= kKeyMin && key < kKeyMax + 1; }
  // std::floor is a call on baseline x86-64; this is not.
  static std::int32_t floor_to_key(double key) {
    const auto truncated = static_cast<std::int32_t>(key);
    return truncated - (static_cast<double>(truncated) > key ? 1 : 0);
  }

  double resolution_m_;
  double per_metre_;
};

}  // namespace warren
