// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_query.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "core/layer/merge_map.hpp"
#include "core/voxel/morton.hpp"
#include "tools/warren-bench/octomap_codes_peer.hpp"
#include "tools/warren-bench/stopwatch.hpp"

namespace warren {
namespace {

constexpr std::size_t kPoints = 200000;
// The least of so many counts, after one to warm the cache: what else the machine does only adds.
constexpr int kQueryRepeats = 9;
// Each quarter reaches so far beyond the middle, as a share of the map's width.
constexpr double kOverlap = 0.125;
constexpr std::array<std::uint32_t, 4> kQuarters = {0, 1, 2, 3};

// Not by whole blocks, nor by whole voxels, and turned by two degrees.
Eigen::Isometry3d moved() {
  return Eigen::Translation3d(0.37, -0.23, 0.11) *
         Eigen::AngleAxisd(0.035, Eigen::Vector3d::UnitZ());
}

class Bounds {
 public:
  void take(const VoxelKey& key) {
    low_ = {std::min(low_.x, key.x), std::min(low_.y, key.y), std::min(low_.z, key.z)};
    high_ = {std::max(high_.x, key.x), std::max(high_.y, key.y), std::max(high_.z, key.z)};
  }
  // Whether the quarter holds the voxel; bit 0 of its number tells the side along x, bit 1 along y.
  bool quarter_holds(std::uint32_t quarter, const VoxelKey& key) const {
    const auto holds = [](bool upper, std::int32_t at, std::int32_t low, std::int32_t high) {
      const double share = (at - low) / std::max(1.0, static_cast<double>(high - low));
      return upper ? share > 0.5 - kOverlap : share < 0.5 + kOverlap;
    };
    return holds((quarter & 1) != 0, key.x, low_.x, high_.x) &&
           holds((quarter & 2) != 0, key.y, low_.y, high_.y);
  }
  std::vector<Point3f> random_points(double resolution_m) const {
    std::mt19937_64 random(1);
    const auto axis = [&](std::int32_t low, std::int32_t high) {
      std::uniform_real_distribution<double> at(low * resolution_m, (high + 1) * resolution_m);
      return static_cast<float>(at(random));
    };
    std::vector<Point3f> points(kPoints);
    for (Point3f& point : points) {
      point.x = axis(low_.x, high_.x);
      point.y = axis(low_.y, high_.y);
      point.z = axis(low_.z, high_.z);
    }
    return points;
  }

 private:
  VoxelKey low_{kKeyMax, kKeyMax, kKeyMax};
  VoxelKey high_{kKeyMin, kKeyMin, kKeyMin};
};

VoxelKey middle_of(BlockOrdinal block) {
  const VoxelKey first = first_voxel_of(block_key_of(block));
  return {first.x + 4, first.y + 4, first.z + 4};
}

std::vector<Replica> quarters_of(const Replica& layer) {
  std::vector<CodedBlock> blocks;
  Bounds bounds;
  layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    blocks.push_back({block, found.codes});
    bounds.take(middle_of(block));
    return true;
  });
  std::vector<Replica> quarters;
  for (const std::uint32_t quarter : kQuarters) {
    std::vector<CodedBlock> within;
    std::copy_if(blocks.begin(), blocks.end(), std::back_inserter(within), [&](const auto& block) {
      return bounds.quarter_holds(quarter, middle_of(block.block));
    });
    quarters.emplace_back(LayerId{quarter + 1, 1, 1}, layer.resolution()).publish(within);
  }
  return quarters;
}

// The voxels of the merge-map, blocks in Morton order.
std::vector<ChangedVoxel> voxels_of(MergeMap& map, Bounds& bounds) {
  std::vector<ChangedVoxel> voxels;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, const MergedVoxel& voxel) {
    voxels.push_back({morton_of(key), voxel.code});
    bounds.take(key);
  });
  return voxels;
}

template <typename Search>
std::size_t ask(const std::vector<Point3f>& points, std::vector<VoxelState>& states,
                double& least_ns, Search&& search) {
  Stopwatch watch;
  watch.time([&] { search(points, states); });
  least_ns = std::min(least_ns, 1e6 * watch.ms_per(points.size()));
  return points.size() -
         static_cast<std::size_t>(std::count(states.begin(), states.end(), VoxelState::kUnknown));
}

}  // namespace

std::optional<QueryCost> bench_query(const Replica& layer, double resolution_m) {
  const std::vector<Replica> quarters = quarters_of(layer);
  MergeMap map({.resolution_m = resolution_m});
  for (const Replica& quarter : quarters) {
    const bool last = &quarter == &quarters.back();
    map.add_layer(quarter.id(), quarter, resolution_m,
                  last ? moved() : Eigen::Isometry3d::Identity());
  }
  Bounds bounds;
  const std::vector<ChangedVoxel> voxels = voxels_of(map, bounds);
  if (voxels.empty()) return std::nullopt;
  OctomapCodesPeer octomap(resolution_m, true);
  octomap.insert(voxels);
  octomap.finish();

  const std::vector<Point3f> points = bounds.random_points(resolution_m);
  std::vector<VoxelState> ours(points.size());
  std::vector<VoxelState> theirs(points.size());
  QueryCost cost{1e300, 1e300, 0.0};
  for (int i = 0; i <= kQueryRepeats; ++i) {
    const std::size_t known = ask(points, ours, cost.ours_ns, [&](const auto& at, auto& states) {
      std::transform(at.begin(), at.end(), states.begin(),
                     [&](const Point3f& point) { return map.voxel(point).code.state(); });
    });
    ask(points, theirs, cost.octomap_ns,
        [&](const auto& at, auto& states) { octomap.search(at, states); });
    if (ours != theirs) return std::nullopt;
    cost.known_share = static_cast<double>(known) / static_cast<double>(points.size());
  }
  return cost;
}

}  // namespace warren
