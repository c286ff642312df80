// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "tests/core/layer/merge_oracle.hpp"
#include "tests/core/layer/random_codes.hpp"

namespace warren::test {

// Layers of others and of this node with random content, a merge-map told of everything that
// happens to them, and the oracle's view of the same.
class MergeWorld {
 public:
  MergeWorld(std::uint64_t seed, MergeRule rule, std::size_t cached_blocks);

  // Something happens: a publication, a move, a retraction, ...
  void step();

  MergeMap& map() { return map_; }
  const OracleLayers& layers() const { return layers_; }
  MergedVoxels by_definition() const {
    return merged_by_definition(layers_, map_.config().resolution_m, map_.config().rule);
  }
  // Another merge-map of the layers as they are now, told in a random order, after detours.
  MergedVoxels merged_anew();

 private:
  struct Foreign {
    std::unique_ptr<Replica> replica;
    bool merged = false;
  };

  MergeSourceId any_layer();
  Eigen::Isometry3d random_pose(double resolution_m);
  std::vector<CodedBlock> random_blocks();
  void publish(const MergeSourceId& id);
  void move(const MergeSourceId& id);
  void add_or_remove(const MergeSourceId& id);
  void add_to(MergeMap& map, const MergeSourceId& id);
  void retract_or_restore(const MergeSourceId& id);
  void take_in(OracleLayer& layer, const std::vector<CodedBlock>& blocks);

  Random random_;
  MergeMap map_;
  std::map<MergeSourceId, Foreign> foreign_;
  std::map<MergeSourceId, std::map<BlockOrdinal, CodeBlock>> own_;
  OracleLayers layers_;
  std::int64_t now_ns_ = 1;
};

}  // namespace warren::test
