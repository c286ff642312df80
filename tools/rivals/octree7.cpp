// SPDX-License-Identifier: Apache-2.0
#include "tools/rivals/octree7.hpp"

#include "tools/rivals/bit_stream.hpp"

namespace warren {
namespace {

constexpr std::uint32_t kStateMask = 3;

void write_node(BitWriter& bits, ChangedVoxels voxels, int level, Pruning pruning) {
  const auto children = children_of(voxels, level);
  for (const ChangedVoxels& child : children) {
    const SlotState state = slot_state(child, level - 1, pruning);
    const bool leaf = state == SlotState::kFree || state == SlotState::kOccupied;
    bits.put(leaf ? child[0].code.bits() : static_cast<std::uint32_t>(state), VoxelCode::kBits);
  }
  for (const ChangedVoxels& child : children) {
    if (slot_state(child, level - 1, pruning) != SlotState::kInner) continue;
    write_node(bits, child, level - 1, pruning);
  }
}

VoxelCode code_of(std::uint32_t slot) {
  if (static_cast<SlotState>(slot & kStateMask) == SlotState::kFree) return VoxelCode::free();
  return VoxelCode::occupied(static_cast<CostCode>(slot >> 2 & 15), (slot >> 6 & 1) != 0);
}

void read_node(BitReader& bits, std::uint64_t first_morton, int level,
               std::vector<ChangedVoxel>& voxels) {
  std::array<std::uint32_t, 8> slots{};
  for (std::uint32_t& slot : slots) slot = bits.get(VoxelCode::kBits);
  for (const std::uint32_t slot : slots) {
    const auto state = static_cast<SlotState>(slot & kStateMask);
    if (state == SlotState::kInner) {
      read_node(bits, first_morton, level - 1, voxels);
    } else if (state != SlotState::kUnchanged) {
      add_leaf(voxels, first_morton, level - 1, code_of(slot));
    }
    first_morton += voxels_of_level(level - 1);
  }
}

}  // namespace

std::vector<std::uint8_t> encode_octree7(ChangedVoxels voxels, Pruning pruning) {
  BitWriter bits;
  if (!voxels.empty()) write_node(bits, voxels, kTreeLevels, pruning);
  return bits.take();
}

std::vector<ChangedVoxel> decode_octree7(std::span<const std::uint8_t> bytes) {
  std::vector<ChangedVoxel> voxels;
  BitReader reader(bytes);
  // A branch ends at a voxel at the latest, whatever the bits say.
  if (!bytes.empty()) read_node(reader, 0, kTreeLevels, voxels);
  return voxels;
}

}  // namespace warren
