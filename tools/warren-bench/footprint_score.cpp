// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/footprint_score.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace warren {
namespace {

std::uint64_t column_key(std::int32_t x, std::int32_t y) {
  return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(y);
}

}  // namespace

std::int32_t VoxelCosts::index_of(double metres) const {
  return static_cast<std::int32_t>(std::floor(metres / resolution_m_));
}

void VoxelCosts::assign(std::span<const JudgedPoint> points) {
  struct Sum {
    double cost = 0.0;
    double points = 0.0;
  };
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, Sum> sums;
  for (const JudgedPoint& point : points) {
    if (!point.has_cost()) continue;
    const Point3f& p = point.position_layer;
    Sum& sum = sums[{index_of(p.x), index_of(p.y), index_of(p.z)}];
    sum.cost += point.cost;
    sum.points += 1.0;
  }
  columns_.clear();
  for (const auto& [place, sum] : sums) {
    const auto [x, y, z] = place;
    columns_[column_key(x, y)].push_back({z, sum.cost / sum.points});
  }
}

void VoxelCosts::add_column(std::uint64_t key, const Heights& heights, Tally& tally) const {
  ++tally.columns;
  const auto column = columns_.find(key);
  if (column == columns_.end()) return;
  const std::size_t before = tally.voxels;
  for (const Voxel& voxel : column->second) {
    const double z_m = centre_m(voxel.z);
    if (z_m < heights.lowest_m || z_m > heights.highest_m) continue;
    tally.sum += voxel.mean;
    tally.most = std::max(tally.most, voxel.mean);
    ++tally.voxels;
  }
  if (tally.voxels > before) ++tally.known_columns;
}

std::optional<double> VoxelCosts::score(const Point3f& place, const SweptCylinder& cylinder) const {
  const double radius_m = cylinder.radius_m;
  const Heights heights{place.z - cylinder.below_m, place.z + cylinder.above_m};
  Tally tally;
  for (std::int32_t x = index_of(place.x - radius_m); x <= index_of(place.x + radius_m); ++x) {
    for (std::int32_t y = index_of(place.y - radius_m); y <= index_of(place.y + radius_m); ++y) {
      if (std::hypot(centre_m(x) - place.x, centre_m(y) - place.y) > radius_m) continue;
      add_column(column_key(x, y), heights, tally);
    }
  }
  const double needed = cylinder.least_known_share * static_cast<double>(tally.columns);
  if (tally.voxels == 0 || static_cast<double>(tally.known_columns) < needed) return std::nullopt;
  return std::max(tally.sum / static_cast<double>(tally.voxels), tally.most / 2.0);
}

}  // namespace warren
