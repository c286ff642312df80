// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/voxel/key.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// A map as planners read it, voxel by voxel.
class TerrainView {
 public:
  virtual ~TerrainView() = default;

  virtual const Lattice& lattice() const = 0;
  virtual VoxelState state(const VoxelKey& key) const = 0;
  // Nothing is "no data".
  virtual std::optional<float> cost(const VoxelKey& key) const = 0;
  virtual bool is_stair(const VoxelKey& key) const = 0;
};

// A self-map holds no stairs.
class SelfMapView : public TerrainView {
 public:
  // Keeps a reference.
  explicit SelfMapView(const SelfMap& map) : map_(map) {}

  const Lattice& lattice() const override { return map_.lattice(); }
  VoxelState state(const VoxelKey& key) const override { return map_.state(key); }
  std::optional<float> cost(const VoxelKey& key) const override { return map_.cost(key); }
  bool is_stair(const VoxelKey&) const override { return false; }

 private:
  const SelfMap& map_;
};

}  // namespace warren
