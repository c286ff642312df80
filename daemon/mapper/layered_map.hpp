// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/map_snapshot.hpp"
#include "core/layer/coded_block.hpp"
#include "core/terrain/scan_pipeline.hpp"
#include "core/voxel/self_map.hpp"
#include "daemon/ingest/messages.hpp"
#include "daemon/mapper/ground_answer.hpp"
#include "daemon/store/store_batch.hpp"

namespace warren {

inline constexpr const char* kNoMapYet = "there is no map yet: no scan has been taken";

struct MappingConfig {
  SelfMapConfig map;
  TerrainConfig terrain = TerrainConfig::robust();
  Pose T_fleet_map{};      // of a layer that is opened, until a pose update comes
  bool is_stored = false;  // then what is handed over has what a store keeps, too
};

// What was mapped in one frame epoch.
struct Layer {
  std::uint32_t number;  // among those of this node, in all its lives
  std::uint64_t frame_epoch;
  LayerOrigin origin;
  SelfMap voxels;
  std::uint64_t scans = 0;
  Pose T_fleet_map;
  Eigen::Vector3d gravity_map{0.0, 0.0, -1.0};    // of the scan taken last
  std::uint32_t handed_over = 0;                  // the self-map's cursor at the last hand-over
  std::uint32_t stored = 0;                       // likewise, of what is handed over to be stored
  std::optional<Eigen::Vector3d> position_map{};  // of the sensor, at the scan taken last
};

// What changed in one layer since it was last handed over, exactly.
struct LayerChanges {
  std::uint32_t number = 0;  // of the layer
  LayerOrigin origin;
  Pose T_fleet_map;
  Eigen::Vector3d gravity_map;  // of the scan taken last
  std::vector<CodedBlock> blocks;
  std::optional<Eigen::Vector3d> position_map{};  // of the sensor, at the scan taken last
  std::optional<SelfLayerWrite> to_store{};
};

// Layers as a store had them, and the number that the next one gets.
struct StoredMap {
  std::vector<std::pair<SelfLayerHead, SelfMap>> layers;  // by their numbers
  std::uint32_t next_number = 0;
};

// The current layer and where it lies, in numbers.
struct MapInfoReport {
  double resolution_m = 0.0;
  std::uint32_t layers = 0;
  std::size_t memory_bytes = 0;  // of all layers
  struct Current {
    std::uint64_t frame_epoch = 0;
    std::uint64_t scans = 0;
    MapCounts counts;
    CostCounts costs;
    Eigen::Vector3d origin_map_m = Eigen::Vector3d::Zero();
    struct Box {
      Eigen::Vector3d low_map_m;
      Eigen::Vector3d high_map_m;
    };
    std::optional<Box> known;
    Pose T_fleet_map;
  };
  std::optional<Current> current;  // nothing before the first scan
};

// Layers by frame epoch. An epoch that is met for the first time opens a layer around its first
// pose and freezes those before it; only a scan with a usable pose can do that. One thread.
class LayeredMap {
 public:
  // Memory grows with every layer, and a client could name a new epoch in every scan.
  static constexpr std::size_t kMaxLayers = 256;

  explicit LayeredMap(const MappingConfig& config)
      : config_(config.map),
        T_fleet_map_(config.T_fleet_map),
        is_stored_(config.is_stored),
        pipeline_(config.terrain) {}
  // Before the first scan. All of it is handed over at the next tick.
  void restore(StoredMap stored);

  // Points used; or why the scan as a whole was not, in words for the client.
  tl::expected<std::uint64_t, std::string> integrate(Scan scan, std::uint64_t frame_epoch,
                                                     const SensorFilter& filter);
  // False, and nothing changed: not the current epoch, or no rigid pose.
  bool update_pose(const PoseUpdateMessage& update);

  const Layer* current() const { return layers_.empty() ? nullptr : layers_.back().get(); }
  std::size_t layer_count() const { return layers_.size(); }
  const RejectionCounts& rejected() const { return rejected_; }
  // Counts a scan that is not integrated; gives the reason's name.
  tl::unexpected<std::string> reject(Rejection reason);
  MapInfoReport info() const;
  // In the current layer; or why there is no answer, in words for the client.
  tl::expected<GroundAnswer, std::string> ground(const GroundQuestion& question) const;
  // What changed since the last call: of layers that changed, and of the current one even if
  // nothing did. In the order in which they were opened.
  std::vector<LayerChanges> take_changes();
  // A copy of the current layer; nothing before the first scan.
  std::shared_ptr<const MapSnapshot> snapshot() const;

 private:
  tl::expected<Layer*, std::string> layer_for(const Scan& scan, std::uint64_t frame_epoch);
  tl::expected<Layer*, std::string> open_layer(const Scan& scan, std::uint64_t frame_epoch);

  SelfLayerWrite write_of(Layer& layer) const;

  SelfMapConfig config_;
  Pose T_fleet_map_;
  bool is_stored_;
  std::uint32_t next_number_ = 0;
  std::vector<std::unique_ptr<Layer>> layers_;  // the last is the current one
  ScanPreparer preparer_;
  ScanPipeline pipeline_;
  RejectionCounts rejected_{};
};

}  // namespace warren
