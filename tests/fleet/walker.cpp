// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/walker.hpp"

#include <algorithm>
#include <map>

namespace warren::fleet_sim {

// A floor of occupied voxels with costs under free space, uneven at random.
void Walker::scribble(BlockCodes& codes) {
  const std::uint32_t first = random_.below(kVoxelsPerBlock);
  for (std::uint32_t i = 0; i < config_.voxels_per_block; ++i) {
    const std::uint32_t place = (first + i) % kVoxelsPerBlock;
    const bool occupied = random_.chance(0.15);
    codes.set(place, occupied ? VoxelCode::occupied(static_cast<CostCode>(random_.below(16)),
                                                    random_.chance(0.05))
                              : VoxelCode::free());
  }
}

std::vector<CodedBlock> Walker::step(const Replica& layer) {
  const auto sideways = [&] { return static_cast<std::int32_t>(random_.below(3)) - 1; };
  at_.x = std::clamp(at_.x + sideways(), -200, 200);
  at_.y = std::clamp(at_.y + sideways(), -200, 200);
  std::map<BlockOrdinal, CodedBlock> changed;
  for (std::uint32_t i = 0; i < config_.blocks_per_step; ++i) {
    const BlockOrdinal block =
        ordinal_of({at_.x + sideways(), at_.y + sideways(), at_.z + sideways()});
    BlockCodes codes = layer.codes_in_place(block).unpack();
    if (random_.chance(config_.emptied)) {
      codes = BlockCodes();
    } else {
      scribble(codes);
    }
    changed.insert_or_assign(block, CodedBlock{block, CodeBlock(codes)});
  }
  std::vector<CodedBlock> blocks;
  for (auto& [block, codes] : changed) blocks.push_back(std::move(codes));
  return blocks;
}

}  // namespace warren::fleet_sim
