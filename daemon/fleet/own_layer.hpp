// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "core/layer/publishing_config.hpp"
#include "core/layer/replica.hpp"
#include "daemon/fleet/rest_schedule.hpp"
#include "daemon/fleet/restored_node.hpp"

namespace warren {

// What the diff-maps of a layer came to: each tick's changes once, as one broadcast would.
struct DiffTraffic {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
  std::uint64_t bytes_of_last_tick = 0;

  DiffTraffic& operator+=(const DiffTraffic& other) {
    packets += other.packets;
    bytes += other.bytes;
    bytes_of_last_tick += other.bytes_of_last_tick;
    return *this;
  }
};

// A layer that this node writes, with what it publishes at each tick. One thread.
class OwnLayer {
 public:
  // `origin_map` is where its key (0, 0, 0) lies in its map frame, metres.
  OwnLayer(const LayerId& id, Resolution resolution, const Eigen::Vector3d& origin_map,
           const PublishingConfig& config, std::uint32_t rest_after_ticks)
      : config_(config),
        T_map_layer_(origin_map),
        layer_(id, resolution),
        publisher_(config.rules),
        rest_(rest_after_ticks) {}

  // As a store had it; what was held back follows from the exact codes of all its blocks, which the
  // next tick must have.
  OwnLayer(StoredOwnLayer stored, const PublishingConfig& config, std::uint32_t rest_after_ticks);

  // Its map frame lies there now.
  void move(const Eigen::Isometry3d& T_fleet_map);

  // The operator's word on that, as LayerPose::update_correction() takes it.
  bool correct(const WrittenPose& correction);

  // The exact codes of the blocks that changed since the last tick, none of them twice.
  void tick(std::span<const CodedBlock> changed);
  // Publishes what is held back: in so many blocks.
  std::size_t flush();

  // To be called at every tick: packs what has been unchanged for long, at most so many regions;
  // how many it did.
  std::size_t rest(std::size_t most) { return rest_quiet_regions(layer_, rest_, most); }

  const Replica& layer() const { return layer_; }
  const Eigen::Translation3d& T_map_layer() const { return T_map_layer_; }
  // Corrected.
  const Eigen::Isometry3d& T_fleet_map() const { return corrected_T_fleet_map_; }
  Eigen::Isometry3d T_fleet_layer() const { return corrected_T_fleet_map_ * T_map_layer_; }
  const DiffTraffic& traffic() const { return traffic_; }
  std::size_t blocks_held_back() const { return publisher_.blocks_held_back(); }
  std::size_t held_back_bytes() const { return publisher_.memory_bytes(); }

 private:
  void publish(std::span<const CodedBlock> blocks);
  void apply_correction();

  PublishingConfig config_;
  Eigen::Translation3d T_map_layer_;
  Eigen::Isometry3d T_fleet_map_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d corrected_T_fleet_map_ = Eigen::Isometry3d::Identity();
  bool is_placed_ = false;
  Replica layer_;
  Publisher publisher_;
  RestSchedule rest_;
  DiffTraffic traffic_;
  std::uint32_t ticks_at_rest_ = 0;
};

}  // namespace warren
