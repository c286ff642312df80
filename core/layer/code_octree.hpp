// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "core/layer/code_mix.hpp"
#include "core/layer/replica.hpp"
#include "core/voxel/key.hpp"

namespace warren {

// A cube of 2^level voxels per edge.
struct CodeNode {
  VoxelKey low;  // the corner with the smallest keys
  int level = 0;
  VoxelCode code;
  bool has_children = false;  // then codes differ within it, and `code` is CodeMix::worst()

  static CodeNode of(const VoxelKey& low, int level, const CodeMix& mix) {
    const auto uniform = mix.uniform();
    return {low, level, uniform.value_or(mix.worst()), !uniform};
  }
};

// A layer as a read-only octree, pruned where eight children have equal codes: costs are never
// averaged. It is computed while it is read; nothing is stored. Level 0 is a voxel, level 16 the
// whole key space.
class CodeOctree {
 public:
  static constexpr int kRootLevel = 16;

  explicit CodeOctree(const Replica& layer) : layer_(&layer) {}

  // The cube of 2^level voxels around a voxel.
  CodeNode node(const VoxelKey& key, int level) const;

  // Visits the pruned tree's leaves in Morton order, none smaller than 2^min_level voxels, and none
  // of which nothing is known: what is mixed at that level comes with has_children.
  void for_each_leaf(int min_level, const std::function<void(const CodeNode&)>& visit) const;

 private:
  const Replica* layer_;
};

}  // namespace warren
