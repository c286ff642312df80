// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_placement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace warren {
namespace {

constexpr double kRigidTolerance = 1e-6;
constexpr double kShiftTolerance = 1e-6;     // voxels
constexpr double kRotationTolerance = 1e-9;  // of the matrix; 1e-4 voxels at the space's far end
// A centre so little below a border counts as above it: borders often coincide, and roundings must
// not decide.
constexpr double kBorderSlack = 1e-6;
constexpr double kBoxMargin = 1e-3;  // voxels

constexpr std::int64_t kBlockMin = kKeyMin / kBlockEdge;
constexpr std::int64_t kBlockMax = (kKeyMax + 1) / kBlockEdge - 1;

bool is_rigid(const Eigen::Isometry3d& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d rotation = pose.linear();
  const Eigen::Matrix3d off = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  return off.cwiseAbs().maxCoeff() < kRigidTolerance && rotation.determinant() > 0.0 &&
         pose.translation().cwiseAbs().maxCoeff() < MergePlacement::kFarthest_m;
}

std::optional<std::int32_t> key_at(double coordinate) {
  const double floored = std::floor(coordinate + kBorderSlack);
  if (!(floored >= kKeyMin && floored <= kKeyMax)) return std::nullopt;
  return static_cast<std::int32_t>(floored);
}

BlockBox clipped_box(const std::array<std::int64_t, 3>& low,
                     const std::array<std::int64_t, 3>& high) {
  std::array<std::int32_t, 3> from{};
  std::array<std::int32_t, 3> to{};
  bool clipped = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clipped = clipped || low[axis] < kBlockMin || high[axis] > kBlockMax;
    from[axis] = static_cast<std::int32_t>(std::clamp(low[axis], kBlockMin, kBlockMax + 1));
    to[axis] = static_cast<std::int32_t>(std::clamp(high[axis], kBlockMin - 1, kBlockMax));
  }
  return {{from[0], from[1], from[2]}, {to[0], to[1], to[2]}, clipped};
}

}  // namespace

std::size_t BlockBox::size() const {
  if (low.x > high.x || low.y > high.y || low.z > high.z) return 0;
  const auto edge = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>(to - from) + 1;
  };
  return edge(low.x, high.x) * edge(low.y, high.y) * edge(low.z, high.z);
}

std::optional<std::size_t> BlockBox::index_of(const BlockKey& key) const {
  const bool inside = key.x >= low.x && key.x <= high.x && key.y >= low.y && key.y <= high.y &&
                      key.z >= low.z && key.z <= high.z;
  if (!inside) return std::nullopt;
  const auto width = static_cast<std::size_t>(high.x - low.x) + 1;
  const auto depth = static_cast<std::size_t>(high.y - low.y) + 1;
  return (static_cast<std::size_t>(key.z - low.z) * depth +
          static_cast<std::size_t>(key.y - low.y)) *
             width +
         static_cast<std::size_t>(key.x - low.x);
}

bool MergePlacement::is_resolution_near(double layer_resolution_m, double merge_resolution_m) {
  return layer_resolution_m > 0.0 &&
         layer_resolution_m <= kResolutionRatioMax * merge_resolution_m &&
         merge_resolution_m <= kResolutionRatioMax * layer_resolution_m;
}

std::optional<MergePlacement> MergePlacement::at(const Eigen::Isometry3d& T_merge_layer,
                                                 double layer_resolution_m,
                                                 double merge_resolution_m) {
  assert(is_resolution_near(layer_resolution_m, merge_resolution_m));
  if (!is_rigid(T_merge_layer)) return std::nullopt;
  const Eigen::Isometry3d T_layer_merge = T_merge_layer.inverse();
  MergePlacement placement;
  placement.to_merge_ = {T_merge_layer.linear() * (layer_resolution_m / merge_resolution_m),
                         T_merge_layer.translation() / merge_resolution_m};
  placement.to_layer_ = {T_layer_merge.linear() * (merge_resolution_m / layer_resolution_m),
                         T_layer_merge.translation() / layer_resolution_m};

  const Map& map = placement.to_merge_;
  const Eigen::Vector3d whole = map.offset.array().round();
  const Eigen::Matrix3d turned = map.linear - Eigen::Matrix3d::Identity();
  if (turned.cwiseAbs().maxCoeff() < kRotationTolerance &&
      (map.offset - whole).cwiseAbs().maxCoeff() < kShiftTolerance) {
    placement.shift_ = {std::llround(whole.x()), std::llround(whole.y()), std::llround(whole.z())};
  }
  return placement;
}

std::optional<VoxelKey> MergePlacement::to_merge(const VoxelKey& layer) const {
  return through(to_merge_, layer);
}

std::optional<VoxelKey> MergePlacement::to_layer(const VoxelKey& merge) const {
  return through(to_layer_, merge);
}

BlockBox MergePlacement::blocks_in_merge(const BlockKey& layer) const {
  return is_shift() ? shifted(layer, *shift_, 1) : box_through(to_merge_, layer);
}

BlockBox MergePlacement::blocks_in_layer(const BlockKey& merge) const {
  return is_shift() ? shifted(merge, *shift_, -1) : box_through(to_layer_, merge);
}

std::optional<VoxelKey> MergePlacement::through(const Map& map, const VoxelKey& key) {
  const Eigen::Vector3d centre(key.x + 0.5, key.y + 0.5, key.z + 0.5);
  const Eigen::Vector3d moved = map.linear * centre + map.offset;
  const auto x = key_at(moved.x());
  const auto y = key_at(moved.y());
  const auto z = key_at(moved.z());
  if (!x || !y || !z) return std::nullopt;
  return VoxelKey{*x, *y, *z};
}

BlockBox MergePlacement::box_through(const Map& map, const BlockKey& key) {
  const VoxelKey first = first_voxel_of(key);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(kBlockEdge / 2.0);
  const Eigen::Vector3d centre =
      map.linear * (Eigen::Vector3d(first.x, first.y, first.z) + half) + map.offset;
  const Eigen::Vector3d reach =
      map.linear.cwiseAbs() * half + Eigen::Vector3d::Constant(kBoxMargin);
  std::array<std::int64_t, 3> low{};
  std::array<std::int64_t, 3> high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    low[axis] = static_cast<std::int64_t>(std::floor((centre[i] - reach[i]) / kBlockEdge));
    high[axis] = static_cast<std::int64_t>(std::floor((centre[i] + reach[i]) / kBlockEdge));
  }
  return clipped_box(low, high);
}

BlockBox MergePlacement::shifted(const BlockKey& key, const std::array<std::int64_t, 3>& shift,
                                 int sign) {
  const VoxelKey first = first_voxel_of(key);
  const std::array<std::int32_t, 3> firsts = {first.x, first.y, first.z};
  std::array<std::int64_t, 3> low{};
  std::array<std::int64_t, 3> high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t moved = firsts[axis] + sign * shift[axis];
    low[axis] = moved >> 3;
    high[axis] = (moved + kBlockEdge - 1) >> 3;
  }
  return clipped_box(low, high);
}

}  // namespace warren
