// SPDX-License-Identifier: Apache-2.0
#include "tools/rivals/tree_zstd.hpp"

#include <zstd.h>

#include "tools/rivals/bit_stream.hpp"

namespace warren {
namespace {

constexpr int kSlotBits = 2;
constexpr int kAttributeBits = 5;  // 4 of cost, 1 of stair

struct TreeWriter {
  BitWriter slots;
  BitWriter attributes;

  void write_node(ChangedVoxels voxels, int level) {
    const auto children = children_of(voxels, level);
    for (const ChangedVoxels& child : children) {
      const SlotState state = slot_state(child, level - 1, Pruning::kEqualCodes);
      slots.put(static_cast<std::uint32_t>(state), kSlotBits);
    }
    for (const ChangedVoxels& child : children) {
      const SlotState state = slot_state(child, level - 1, Pruning::kEqualCodes);
      if (state == SlotState::kOccupied) attributes.put(child[0].code.bits() >> 2, kAttributeBits);
      if (state == SlotState::kInner) write_node(child, level - 1);
    }
  }
};

struct Leaf {
  std::uint64_t first_morton = 0;
  int level = 0;
  SlotState state = SlotState::kUnchanged;
};

void read_node(BitReader& slots, std::uint64_t first_morton, int level, std::vector<Leaf>& leaves) {
  std::array<SlotState, 8> states{};
  for (SlotState& state : states) state = static_cast<SlotState>(slots.get(kSlotBits));
  for (const SlotState state : states) {
    if (state == SlotState::kInner) {
      read_node(slots, first_morton, level - 1, leaves);
    } else if (state != SlotState::kUnchanged) {
      leaves.push_back({first_morton, level - 1, state});
    }
    first_morton += voxels_of_level(level - 1);
  }
}

}  // namespace

std::vector<std::uint8_t> encode_tree(ChangedVoxels voxels) {
  if (voxels.empty()) return {};
  TreeWriter writer;
  writer.write_node(voxels, kTreeLevels);
  std::vector<std::uint8_t> bytes = writer.slots.take();
  const std::vector<std::uint8_t> attributes = writer.attributes.take();
  bytes.insert(bytes.end(), attributes.begin(), attributes.end());
  return bytes;
}

std::vector<ChangedVoxel> decode_tree(std::span<const std::uint8_t> bytes) {
  std::vector<ChangedVoxel> voxels;
  if (bytes.empty()) return voxels;
  std::vector<Leaf> leaves;
  BitReader slots(bytes);
  read_node(slots, 0, kTreeLevels, leaves);
  BitReader attributes(bytes.subspan(slots.bytes_read()));
  for (const Leaf& leaf : leaves) {
    VoxelCode code = VoxelCode::free();
    if (leaf.state == SlotState::kOccupied) {
      const std::uint32_t bits = attributes.get(kAttributeBits);
      code = VoxelCode::occupied(static_cast<CostCode>(bits & 15), (bits & 16) != 0);
    }
    add_leaf(voxels, leaf.first_morton, leaf.level, code);
  }
  return voxels;
}

std::vector<std::uint8_t> compress_zstd(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> packed(ZSTD_compressBound(bytes.size()));
  packed.resize(
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kZstdLevel));
  return packed;
}

std::vector<std::uint8_t> decompress_zstd(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> unpacked(ZSTD_getFrameContentSize(bytes.data(), bytes.size()));
  unpacked.resize(ZSTD_decompress(unpacked.data(), unpacked.size(), bytes.data(), bytes.size()));
  return unpacked;
}

}  // namespace warren
