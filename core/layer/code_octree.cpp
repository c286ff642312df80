// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_octree.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <vector>

namespace warren {
namespace {

using Visit = std::function<void(const CodeNode&)>;

constexpr int kBlockLevel = 3;

constexpr std::uint64_t blocks_in_cube(int level) {
  return std::uint64_t{1} << 3 * (level - kBlockLevel);
}

CodeNode node_of(std::uint64_t morton, int level, const CodeMix& mix) {
  return CodeNode::of(key_of_morton(morton), level, mix);
}

struct MixedBlock {
  BlockOrdinal block = 0;
  CodeMix mix;
};

std::vector<MixedBlock> mixes_of(const Replica& layer, const KeyInterval& keys) {
  std::vector<MixedBlock> mixes;
  layer.for_each_changed(keys, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    mixes.push_back({block, CodeMix::of(found.codes.unpack(), 0, kVoxelsPerBlock)});
    return true;
  });
  return mixes;
}

// Of a cube of at least a block, given its blocks; those that are not there are unknown.
CodeMix mix_of(std::span<const MixedBlock> blocks, int level) {
  CodeMix mix;
  if (blocks.size() < blocks_in_cube(level)) mix |= CodeMix(VoxelCode{});
  for (const MixedBlock& block : blocks) mix |= block.mix;
  return mix;
}

// From the top down, every step with the blocks that lie in its cube.
class LeafWalk {
 public:
  LeafWalk(const Replica& layer, int min_level, const Visit& visit)
      : layer_(layer), min_level_(min_level), visit_(visit) {}

  void walk_blocks(BlockOrdinal first, int level, std::span<const MixedBlock> blocks) const {
    if (blocks.empty() || emit(first << 9, level, mix_of(blocks, level))) return;
    if (level == kBlockLevel) return walk_voxels(first);
    const std::uint64_t step = blocks_in_cube(level - 1);
    for (BlockOrdinal child = first; child < first + 8 * step; child += step) {
      const auto* const end =
          std::partition_point(blocks.data(), blocks.data() + blocks.size(),
                               [&](const MixedBlock& block) { return block.block < child + step; });
      const auto count = static_cast<std::size_t>(end - blocks.data());
      walk_blocks(child, level - 1, blocks.first(count));
      blocks = blocks.subspan(count);
    }
  }

 private:
  // Whether the cube is a leaf; one that is known is visited.
  bool emit(std::uint64_t morton, int level, const CodeMix& mix) const {
    if (!mix.uniform() && level > min_level_) return false;
    if (mix.uniform() != VoxelCode{}) visit_(node_of(morton, level, mix));
    return true;
  }

  void walk_voxels(BlockOrdinal block) const {
    walk_voxels(block << 9, kBlockLevel, layer_.find(block)->codes.unpack());
  }

  // Children of a cube within a block that is no leaf.
  void walk_voxels(std::uint64_t morton, int level, const BlockCodes& codes) const {
    const std::uint32_t count = 1U << 3 * (level - 1);
    for (std::uint64_t child = morton; child < morton + 8 * count; child += count) {
      const auto first = static_cast<std::uint32_t>(child & (kVoxelsPerBlock - 1));
      const bool is_leaf = emit(child, level - 1, CodeMix::of(codes, first, count));
      if (!is_leaf && level > 1) walk_voxels(child, level - 1, codes);
    }
  }

  const Replica& layer_;
  int min_level_;
  const Visit& visit_;
};

}  // namespace

CodeNode CodeOctree::node(const VoxelKey& key, int level) const {
  assert(level >= 0 && level <= kRootLevel);
  const std::uint64_t morton = morton_of(key) >> 3 * level << 3 * level;
  const BlockOrdinal block = morton >> 9;
  if (level >= kBlockLevel) {
    const KeyInterval keys{block, block + blocks_in_cube(level)};
    return node_of(morton, level, mix_of(mixes_of(*layer_, keys), level));
  }
  const BlockCodes codes = layer_->codes(block).unpack();
  const auto first = static_cast<std::uint32_t>(morton & (kVoxelsPerBlock - 1));
  return node_of(morton, level, CodeMix::of(codes, first, 1U << 3 * level));
}

void CodeOctree::for_each_leaf(int min_level, const Visit& visit) const {
  assert(min_level >= 0 && min_level <= kRootLevel);
  LeafWalk(*layer_, min_level, visit).walk_blocks(0, kRootLevel, mixes_of(*layer_, {}));
}

}  // namespace warren
