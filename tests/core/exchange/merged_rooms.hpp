// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>

#include <doctest/doctest.h>

#include "core/exchange/merged_snapshot.hpp"
#include "core/layer/publisher.hpp"
#include "tests/support/simulated_scans.hpp"

namespace warren::test {

// One's own room, and those of two others that overlap it, in a merge-map.
class MergedRooms {
 public:
  static constexpr LayerId kEast{9, 1, 0xab};
  static constexpr LayerId kNorth{7, 2, 0xcd};
  static constexpr double kResolution_m = 0.1;

  MergedRooms() {
    const std::vector<CodedBlock> room = room_blocks();
    REQUIRE(map_.open_self_layer(1, Eigen::Isometry3d::Identity()) == MergeResult::kDone);
    map_.update_self(1, room);
    add_room(kEast, {9.0, 0.0, 0.0});
    add_room(kNorth, {0.0, 6.0, 0.0});
  }

  void add_room(const LayerId& id, const Eigen::Vector3d& place_m) {
    replicas_.emplace_back(id, kDefaultResolution).publish(room_blocks());
    const Eigen::Isometry3d T_merge_layer(Eigen::Translation3d{place_m});
    REQUIRE(map_.add_layer(id, replicas_.back(), kResolution_m, T_merge_layer) ==
            MergeResult::kDone);
  }

  MergeMap& map() { return map_; }

 private:
  static std::vector<CodedBlock> room_blocks() {
    SelfMap map({kResolution_m, SensorModel{}, false});
    for (const auto& scan : walk_through_room(Room{}, Lidar{}, 3)) map.integrate(scan.view());
    std::vector<VoxelCost> costs;
    map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
      if (state == VoxelState::kOccupied && key.x < 0) costs.push_back({key, 0.3F, 1.0F});
    });
    map.fuse_costs(costs);
    return blocks_changed_since(map, 0);
  }

  MergeMap map_{{kResolution_m}};
  std::list<Replica> replicas_;
};

}  // namespace warren::test
