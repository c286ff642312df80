// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/merged_snapshot.hpp"
#include "core/layer/merge_map.hpp"
#include "daemon/control/request.hpp"
#include "daemon/fleet/blocks_answer.hpp"
#include "daemon/fleet/cells_answer.hpp"
#include "daemon/fleet/loaded_layers.hpp"
#include "daemon/fleet/own_layer.hpp"
#include "daemon/fleet/rays_answer.hpp"
#include "daemon/mapper/layered_map.hpp"

namespace warren {

// All that the fleet thread holds of layers: the sum of the first three.
struct LayerMemory {
  std::size_t own_layers_bytes = 0;  // as published, and what is held back
  std::size_t loaded_layers_bytes = 0;
  std::size_t merge_map_bytes = 0;
  std::size_t at_rest_bytes = 0;  // of the first two
  std::size_t regions = 0;
  std::size_t regions_at_rest = 0;
};

// The layers held, in numbers.
struct PublishingReport {
  std::uint32_t layers = 0;
  DiffTraffic traffic;  // of all layers
  std::uint64_t blocks_held_back = 0;
  LayerMemory memory;
  std::vector<LoadedLayer> loaded;
  std::uint64_t poses_refused = 0;  // of layers: not rigid, or out of reach
  std::uint64_t ticks = 0;
  std::uint64_t ticks_late = 0;  // the one before was not done yet
  struct Current {
    LayerId id;
    Revision revision;
    Hash digest{};
  };
  std::optional<Current> current;  // nothing before the first scan
};

// What a copy of the current own layer lacks.
struct LayerDiff {
  LayerId id;
  Resolution resolution;
  Revision revision;
  std::vector<std::vector<std::uint8_t>> packets;
  BlockOrdinal next_key = kOrdinalEnd;  // where to go on; the end: nothing is missing above
};

// What a flush published.
struct FlushReport {
  LayerId layer;  // the current one
  Revision revision;
  std::uint64_t blocks = 0;  // of all own layers
};

// A layer as a .layer file holds it.
struct EncodedLayer {
  std::vector<std::uint8_t> bytes;
  std::uint64_t voxels = 0;  // known
};

struct FleetMapConfig {
  std::uint32_t origin = 0;  // of the own layers
  Resolution resolution;
  PublishingConfig publishing;
  std::uint32_t rest_after_ticks = 60;
};

// All layers that this node holds, and the merge-map of them, which lies in the map frame of the
// newest own layer. One thread: the fleet's.
class FleetMap {
 public:
  // A region takes some milliseconds.
  static constexpr std::size_t kRegionsRestedPerTick = 8;
  // More than one answer may hold; a follower asks again.
  static constexpr std::size_t kDiffBytesMax = 512 * 1024;

  // Draws incarnations of layers: 64 random bits each time.
  using DrawIncarnation = std::function<std::uint64_t()>;
  FleetMap(const FleetMapConfig& config, DrawIncarnation draw_incarnation)
      : config_(config),
        draw_incarnation_(std::move(draw_incarnation)),
        merge_({config.resolution.metres()}),
        loaded_(merge_, config.rest_after_ticks) {}
  // `told` is called with every own layer when it is opened, before it publishes anything.
  void on_open(std::function<void(const OwnLayer&)> told) { opened_ = std::move(told); }
  FleetMap(const FleetMap&) = delete;
  FleetMap& operator=(const FleetMap&) = delete;

  // Own layers as a store had them, before anything else. The first tick must have all their
  // blocks.
  void restore(std::vector<StoredOwnLayer>&& layers);
  // One tick of all layers, also of those in which nothing changed.
  void tick(std::span<const LayerChanges> changes);
  // Publishes what the sender rules hold back. Nothing before the first scan.
  std::optional<FlushReport> flush();

  // Into the merge-map, where the layer's pose says.
  LoadedLayers::Result load(Replica layer, std::string file);
  LoadedLayers& loaded() { return loaded_; }
  const LoadedLayers& loaded() const { return loaded_; }
  // Takes over where the layers of others lie now.
  void place_others() { loaded_.place(T_merge_fleet()); }

  Eigen::Isometry3d T_merge_fleet() const;
  // What this node measured itself at a place in the merge-map's frame. Fills its cache.
  VoxelState own_state(const Eigen::Vector3d& position_merge);

  const std::map<std::uint32_t, OwnLayer>& own_layers() const { return own_; }
  // The operator's word on where an own layer lies; false if it is none, or not newer.
  bool correct_own(const LayerId& layer, const WrittenPose& correction);
  // Where this node's sensor was at the scan taken last, in the newest own layer.
  std::optional<Eigen::Vector3d> position_layer() const;
  // The same.
  std::optional<Eigen::Vector3d> position_fleet() const;

  // The question is about the map frame of the newest own layer, and without gravity. Fills the
  // merge-map's cache.
  tl::expected<GroundAnswer, std::string> ground(const GroundQuestion& question);
  // Of the current own layer as it is published, or of the merge-map; the question is about the map
  // frame of the newest own layer.
  tl::expected<CellsAnswer, std::string> cells(const CellsQuestion& question);
  // Likewise. A new own layer is a new map frame, in which a copy begins anew.
  tl::expected<BlocksAnswer, std::string> blocks(const BlocksQuestion& question);
  tl::expected<RaysAnswer, std::string> rays(const RaysQuestion& question);
  PublishingReport report() const;
  // All of the merge-map, for a file. Nothing while no layer is held.
  std::shared_ptr<MergedSnapshot> merged_snapshot();
  // A copy of the current own layer, with its pose. Nothing before the first scan.
  std::optional<EncodedLayer> encoded_layer() const;
  static EncodedLayer encoded(const Replica& layer);
  // From the revision that the copy holds at `keys` on. Nothing before the first scan.
  std::optional<LayerDiff> diff(const KeyInterval& keys, Revision from) const;

 private:
  OwnLayer& own_layer(const LayerChanges& changes);
  template <typename... Args>
  OwnLayer& open(std::uint32_t number, const Eigen::Vector3d& origin_map, Args&&... args);
  LayerMemory memory() const;
  const Replica* current() const;
  bool has_map(MapSource source) const {
    return !own_.empty() || (source == MapSource::kMerge && loaded_.size() > 0);
  }
  // Where key (0, 0, 0) of that map lies in the map frame. Precondition: has_map(source).
  Eigen::Vector3d origin_map(MapSource source) const;
  Eigen::Isometry3d T_merge_own(const OwnLayer& layer) const;
  // Layers that lie elsewhere in the merge-map's frame than before are moved there; those beyond
  // its reach are left out of it, and counted.
  void place_layers();
  void rest_quiet_layers();

  FleetMapConfig config_;
  DrawIncarnation draw_incarnation_;
  std::function<void(const OwnLayer&)> opened_ = [](const OwnLayer&) {};
  std::optional<Eigen::Vector3d> position_map_;  // of the newest own layer
  std::map<std::uint32_t, OwnLayer> own_;        // the last is the current one
  // The merge-map's key (0, 0, 0) in the map frame: the newest own layer's, so that what is near it
  // has keys. Metres, whole blocks.
  Eigen::Vector3d merge_origin_map_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_map_{0.0, 0.0, -1.0};
  MergeMap merge_;
  std::map<std::uint32_t, Eigen::Isometry3d> T_merge_own_;  // as placed
  LoadedLayers loaded_;
  std::uint64_t placements_refused_ = 0;  // of own layers
  std::uint64_t ticks_ = 0;
};

}  // namespace warren
