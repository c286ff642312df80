// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/layer/voxel_code.hpp"
#include "core/voxel/bits.hpp"
#include "core/voxel/block_store.hpp"

namespace warren {

inline constexpr std::size_t kVoxelsPerBlock = 512;

// One bit per voxel of a block, in Morton order: a 4x4x4 cell is one word of it.
using VoxelMask = std::array<std::uint64_t, kCellsPerBlock>;

constexpr bool contains(const VoxelMask& mask, std::uint32_t place) {
  return (mask[place >> 6] >> (place & 63) & 1) != 0;
}
constexpr void insert(VoxelMask& mask, std::uint32_t place) {
  mask[place >> 6] |= std::uint64_t{1} << (place & 63);
}
constexpr bool any(const VoxelMask& mask) {
  std::uint64_t bits = 0;
  for (const std::uint64_t cell : mask) bits |= cell;
  return bits != 0;
}

// The codes of a block laid out for reading and writing, places in Morton order. Invariant kept by
// its writers: stairs are part of occupied, occupied of known, and costs other than kNoCostData
// stand only at occupied places.
struct BlockCodes {
  VoxelMask known{};
  VoxelMask occupied{};
  VoxelMask stairs{};
  std::array<CostCode, kVoxelsPerBlock> costs{};

  VoxelCode at(std::uint32_t place) const;
  void set(std::uint32_t place, VoxelCode code);
  // Takes over the voxels that `codes` knows.
  void overlay(const BlockCodes& codes);

  friend bool operator==(const BlockCodes&, const BlockCodes&) = default;
};

// The codes of a block at rest: two bits per voxel, and four or five more per occupied one. Equal
// codes are equal objects.
class CodeBlock {
 public:
  CodeBlock() = default;
  explicit CodeBlock(const BlockCodes& codes);

  BlockCodes unpack() const;
  VoxelCode at(std::uint32_t place) const;
  const VoxelMask& known() const { return known_; }
  const VoxelMask& occupied() const { return occupied_; }
  // Costs and stairs of the occupied voxels, packed; equal for equal codes.
  std::span<const std::uint8_t> attributes() const { return attributes_; }
  bool empty() const { return !any(known_); }

  // Calls visit(place, VoxelCode) for every known voxel, in Morton order.
  template <typename Visit>
  void for_each_known(Visit&& visit) const;

  std::size_t heap_bytes() const { return attributes_.capacity(); }
  friend bool operator==(const CodeBlock&, const CodeBlock&) = default;

 private:
  VoxelCode occupied_code(std::uint32_t rank) const;
  std::uint32_t rank_of(std::uint32_t place) const;

  VoxelMask known_{};
  VoxelMask occupied_{};
  // By rank among the occupied voxels: costs, two to the byte; then, if any is a stair, stair bits.
  std::vector<std::uint8_t> attributes_;
};

template <typename Visit>
void CodeBlock::for_each_known(Visit&& visit) const {
  const BlockCodes codes = unpack();
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(known_[cell],
                 [&](std::uint32_t bit) { visit(cell << 6 | bit, codes.at(cell << 6 | bit)); });
  }
}

}  // namespace warren
