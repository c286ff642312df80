// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/voxel/block_state.hpp"
#include "core/voxel/block_store.hpp"
#include "core/voxel/cost_commit.hpp"
#include "core/voxel/key.hpp"
#include "core/voxel/ray_cast.hpp"
#include "core/voxel/scan.hpp"
#include "core/voxel/sensor_model.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {

struct SelfMapConfig {
  double resolution_m = 0.1;
  SensorModel sensor_model;
  // One ray per end voxel, to its centre: faster, not quite the same map (OctoMap's `discretize`).
  bool one_ray_per_end_voxel = false;
  CostFusionConfig cost_fusion{};
};

struct IntegrationReport {
  std::uint64_t points_used = 0;  // of points_layer
  std::uint64_t rays = 0;
  std::uint64_t voxels_hit = 0;
  std::uint64_t voxels_passed = 0;  // passed, not hit, and not yet at the free clamp
  std::uint64_t blocks_changed = 0;
  RejectionCounts rejected{};
};

struct MapCounts {
  std::uint64_t free = 0;
  std::uint64_t occupied = 0;
  std::uint64_t blocks = 0;
};

// Occupied voxels by cost.
struct CostCounts {
  std::uint64_t no_data = 0;
  std::uint64_t up_to_0p10 = 0;
  std::uint64_t up_to_0p20 = 0;  // and above 0.10
  std::uint64_t above_0p20 = 0;
};

// The occupancy map that one robot measured itself, in one layer. After any sequence of scans every
// voxel's state equals that of octomap::OcTree::insertPointCloud with the same parameters.
// Copies are independent snapshots. One thread at a time.
class SelfMap {
 public:
  explicit SelfMap(const SelfMapConfig& config);
  ~SelfMap();
  SelfMap(const SelfMap&);
  SelfMap& operator=(const SelfMap&);
  SelfMap(SelfMap&&) noexcept;
  SelfMap& operator=(SelfMap&&) noexcept;

  const SelfMapConfig& config() const { return config_; }
  const Lattice& lattice() const { return lattice_; }

  // Adds one scan. Each voxel changes at most once; a hit wins over a pass. Never throws on bad
  // numbers: what cannot be used is counted in the report.
  IntegrationReport integrate(const LayerScan& scan);

  // Adds what the scan integrated last tells of its ground. Precondition: no voxel comes twice.
  CostFusionReport fuse_costs(std::span<const VoxelCost> costs);

  VoxelState state(const VoxelKey& key) const;
  VoxelState state(const Point3f& point_layer) const;
  // Log-odds of occupancy; nothing when unknown.
  std::optional<float> log_odds(const VoxelKey& key) const;

  // 0 easy .. 1 impossible; nothing ("no data") when the voxel is not occupied or was never judged.
  std::optional<float> cost(const VoxelKey& key) const;
  std::optional<FusedCost> fused_cost(const VoxelKey& key) const;

  // First voxel along the ray that is occupied (or unknown); nothing when there is none in range.
  // The voxel of the origin itself is looked at too.
  std::optional<RayHit> cast_ray(const RayQuery& query) const;

  // Calls visit(key, state, log_odds) for every known voxel in the box, blocks in Morton order
  // within regions.
  using VoxelVisitor = std::function<void(const VoxelKey&, VoxelState, float log_odds)>;
  void for_each_known_voxel(const KeyBox& box, const VoxelVisitor& visit) const;

  // Blocks whose log-odds or costs changed after the scan numbered `cursor`; 0 gives all. Scans are
  // numbered from 1; cursor() is the number of the last. In no particular order; what did not
  // change costs nothing but a look at a number per region.
  std::vector<BlockKey> blocks_changed_since(std::uint32_t cursor) const;
  std::uint32_t cursor() const { return scans_; }

  // All that is known of a block, to the bit; nothing if nothing is.
  std::optional<BlockState> export_block(const BlockKey& key) const {
    return store_.export_block(key);
  }
  // Takes in what a map of the same config exported. False, and nothing changes, if no such map
  // could have, or something is known of the block already: what a store says is not trusted.
  bool import_block(const BlockState& state);
  // Goes on numbering scans from here, if that is above cursor().
  void import_cursor(std::uint32_t cursor) { scans_ = std::max(scans_, cursor); }

  MapCounts counts() const;
  CostCounts cost_counts() const;
  // Smallest box of blocks that holds all known voxels; nothing when the map is empty.
  std::optional<KeyBox> bounds() const;
  // Heap bytes held, scratch of the integration included.
  std::size_t memory_bytes() const;

  const BlockStore& blocks() const { return store_; }

 private:
  struct Scratch;

  SelfMapConfig config_;
  Lattice lattice_;
  FixedSensorModel model_;
  CostFusion cost_fusion_;
  BlockStore store_;
  std::unique_ptr<Scratch> scratch_;
  std::uint32_t scans_ = 0;
};

}  // namespace warren
