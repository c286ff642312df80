// SPDX-License-Identifier: Apache-2.0
#include "tests/core/layer/merge_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace warren::test {
namespace {

struct Said {
  VoxelCode code;
  std::int64_t changed_ns = 0;
};

std::int32_t floor_key(double coordinate) {
  return static_cast<std::int32_t>(std::floor(coordinate + 1e-6));
}

VoxelKey voxel_around(const Eigen::Vector3d& point_m, double resolution_m) {
  return {floor_key(point_m.x() / resolution_m), floor_key(point_m.y() / resolution_m),
          floor_key(point_m.z() / resolution_m)};
}

Eigen::Vector3d centre_of(const VoxelKey& key, double resolution_m) {
  return (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5)) * resolution_m;
}

void say(std::map<VoxelKey, Said>& said, const VoxelKey& key, const Said& what) {
  if (!KeyBox{}.contains(key)) return;
  const auto entry = said.try_emplace(key, what);
  Said& held = entry.first->second;
  if (entry.second) return;
  const bool was_occupied = held.code.state() == VoxelState::kOccupied;
  const bool is_occupied = what.code.state() == VoxelState::kOccupied;
  if (was_occupied && !is_occupied) return;
  if (!was_occupied) {
    held = what;
    return;
  }
  held.code = VoxelCode::occupied(std::max(held.code.cost(), what.code.cost()),
                                  held.code.stair() || what.code.stair());
  held.changed_ns = std::max(held.changed_ns, what.changed_ns);
}

// Every voxel of the merge-map whose centre lies in this one of the layer.
template <typename Visit>
void for_each_centre_in(const OracleLayer& layer, const VoxelKey& key, double resolution_m,
                        Visit&& visit) {
  const VoxelKey middle =
      voxel_around(layer.T_merge_layer * centre_of(key, layer.resolution_m), resolution_m);
  const auto reach = static_cast<std::int32_t>(std::ceil(layer.resolution_m / resolution_m)) + 1;
  for (std::int32_t x = middle.x - reach; x <= middle.x + reach; ++x) {
    for (std::int32_t y = middle.y - reach; y <= middle.y + reach; ++y) {
      for (std::int32_t z = middle.z - reach; z <= middle.z + reach; ++z) {
        const Eigen::Vector3d centre = centre_of({x, y, z}, resolution_m);
        const VoxelKey back =
            voxel_around(layer.T_merge_layer.inverse() * centre, layer.resolution_m);
        if (back == key) visit(VoxelKey{x, y, z});
      }
    }
  }
}

std::map<VoxelKey, Said> said_by(const OracleLayer& layer, double resolution_m) {
  std::map<VoxelKey, Said> said;
  for (const auto& entry : layer.voxels) {
    const VoxelKey& key = entry.first;
    const auto time = layer.changed_ns.find(block_of(key));
    const Said what{entry.second, time == layer.changed_ns.end() ? 0 : time->second};
    if (what.code.state() == VoxelState::kOccupied) {
      const Eigen::Vector3d centre = centre_of(key, layer.resolution_m);
      say(said, voxel_around(layer.T_merge_layer * centre, resolution_m), what);
    }
    for_each_centre_in(layer, key, resolution_m,
                       [&](const VoxelKey& merge) { say(said, merge, what); });
  }
  return said;
}

struct Merging {
  Said said;
  MergeSourceId source;
};

void merge(Merging& held, const Said& said, const MergeSourceId& source, MergeRule rule) {
  if (source.self) {
    held = {said, source};
    return;
  }
  if (rule == MergeRule::kNewest) {
    if (said.changed_ns > held.said.changed_ns) held = {said, source};
    return;
  }
  const auto rank = [](VoxelCode code) {
    return static_cast<int>(code.state()) * 100 + static_cast<int>(code.cost());
  };
  const bool both =
      held.said.code.state() == VoxelState::kOccupied && said.code.state() == VoxelState::kOccupied;
  const bool stair = both && (held.said.code.stair() || said.code.stair());
  if (rank(said.code) > rank(held.said.code)) held = {said, source};
  if (stair) held.said.code = VoxelCode::occupied(held.said.code.cost(), true);
}

}  // namespace

MergedVoxels voxels_of(MergeMap& map, const KeyBox& box) {
  MergedVoxels voxels;
  map.for_each_known_voxel(box, [&](const VoxelKey& key, const MergedVoxel& voxel) {
    voxels.emplace(key, std::pair{voxel.code.bits(), map.source(voxel.source)});
  });
  return voxels;
}

MergedVoxels merged_by_definition(const OracleLayers& layers, double resolution_m, MergeRule rule) {
  std::map<VoxelKey, Merging> merging;
  for (const auto& layer : layers) {
    if (!layer.second.counts) continue;
    for (const auto& said : said_by(layer.second, resolution_m)) {
      const auto entry = merging.try_emplace(said.first, Merging{said.second, layer.first});
      if (!entry.second) merge(entry.first->second, said.second, layer.first, rule);
    }
  }
  MergedVoxels voxels;
  for (const auto& entry : merging) {
    voxels.emplace(entry.first, std::pair{entry.second.said.code.bits(), entry.second.source});
  }
  return voxels;
}

}  // namespace warren::test
