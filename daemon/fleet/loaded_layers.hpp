// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <tl/expected.hpp>

#include "core/layer/merge_map.hpp"
#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"
#include "daemon/control/request.hpp"
#include "daemon/fleet/rest_schedule.hpp"

namespace warren {

// A layer of others: of an earlier mission, loaded from a file, which nobody goes on writing; or a
// copy that the mesh keeps in step.
struct LoadedLayer {
  LayerId id;
  std::string file;  // empty: a copy
  Resolution resolution;
  MapCounts voxels;
  Pose T_fleet_layer;      // as its pose says and the operator moved it
  bool retracted = false;  // here, or in the whole fleet
  bool retracted_by_fleet = false;
  bool out_of_reach = false;  // of the merge-map, which leaves it out
  bool unplaced = false;      // a copy whose origin has not said where it lies: left out as well
};

// The layers of others and their places in the merge-map. What the operator does with one here is
// this node's affair alone: the layer's own pose stays as it is. One thread.
class LoadedLayers {
 public:
  static constexpr std::size_t kLayersMax = 64;           // of earlier missions
  using Result = tl::expected<LoadedLayer, std::string>;  // or why not, in words for the client

  // The merge-map must outlive this.
  LoadedLayers(MergeMap& merge, std::uint32_t rest_after_ticks)
      : merge_(merge), rest_after_ticks_(rest_after_ticks) {}

  // Where the layer's pose says.
  Result add(Replica layer, std::string file);
  // Likewise, as soon as it has a pose; the copy's changes come to the merge-map. It must outlive
  // this.
  Result add_copy(Replica& copy);
  // As if it had never been loaded, until it is restored.
  Result retract(const LayerId& id) { return set_retracted(id, true); }
  Result restore(const LayerId& id) { return set_retracted(id, false); }
  // The same by an order to the whole fleet; both have to allow it.
  void set_retracted_by_fleet(const LayerId& id, bool retracted);
  // In place of an earlier move.
  Result move(const LayerId& id, const LayerShift& shift);
  // The fleet frame lies there now, and layers where their poses say now. Those that come to lie
  // beyond the merge-map's reach are left out of it, and counted, until they lie within it.
  void place(const Eigen::Isometry3d& T_merge_fleet);
  // To be called at every tick: packs at most so many quiet regions; how many it did.
  std::size_t rest(std::size_t most);

  std::size_t size() const { return layers_.size(); }
  // Those loaded from files.
  std::vector<LoadedLayer> list() const;
  // Nothing if there is none; the voxels of a copy are not counted.
  std::optional<LoadedLayer> find(const LayerId& id) const;
  const Replica* replica(const LayerId& id) const;
  // How often a pose was refused: not rigid, or beyond reach.
  std::uint64_t poses_refused() const;
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const auto& [id, held] : layers_) visit(*held.replica);
  }

 private:
  struct Held {
    std::unique_ptr<Replica> loaded{};  // none: a copy, which is elsewhere
    Replica* replica = nullptr;
    std::string file{};
    MapCounts voxels{};
    RestSchedule rest;
    LayerShift shift{};
    Eigen::Isometry3d T_merge_layer = Eigen::Isometry3d::Identity();
    bool retracted = false;
    bool retracted_by_fleet = false;
    bool out_of_reach = false;
    bool unplaced = false;
  };

  tl::expected<Held*, std::string> add(Held held);
  Result set_retracted(const LayerId& id, bool retracted);
  Held* find_held(const LayerId& id);
  void show(const Held& held);
  void place(Held& held);
  static bool lacks_pose(const Held& held);
  static LoadedLayer report_of(const Held& held);

  MergeMap& merge_;
  std::uint32_t rest_after_ticks_;
  Eigen::Isometry3d T_merge_fleet_ = Eigen::Isometry3d::Identity();
  std::map<LayerId, Held> layers_;  // the merge-map refers to the replicas
  std::uint64_t placements_refused_ = 0;
};

}  // namespace warren
