// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_block.hpp"

#include <bit>

#include "core/voxel/bits.hpp"

namespace warren {
namespace {

std::uint32_t count(const VoxelMask& mask) {
  int bits = 0;
  for (const std::uint64_t cell : mask) bits += std::popcount(cell);
  return static_cast<std::uint32_t>(bits);
}

constexpr std::size_t cost_bytes(std::uint32_t occupied) { return (occupied + 1) / 2; }

template <typename Visit>
void for_each_place(const VoxelMask& mask, Visit&& visit) {
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(mask[cell], [&](std::uint32_t bit) { visit(cell << 6 | bit); });
  }
}

}  // namespace

VoxelCode BlockCodes::at(std::uint32_t place) const {
  if (!contains(known, place)) return {};
  if (!contains(occupied, place)) return VoxelCode::free();
  return VoxelCode::occupied(costs[place], contains(stairs, place));
}

void BlockCodes::set(std::uint32_t place, VoxelCode code) {
  const std::size_t cell = place >> 6;
  const std::uint64_t bit = std::uint64_t{1} << (place & 63);
  known[cell] = code.state() == VoxelState::kUnknown ? known[cell] & ~bit : known[cell] | bit;
  occupied[cell] =
      code.state() == VoxelState::kOccupied ? occupied[cell] | bit : occupied[cell] & ~bit;
  stairs[cell] = code.stair() ? stairs[cell] | bit : stairs[cell] & ~bit;
  costs[place] = code.cost();
}

void BlockCodes::overlay(const BlockCodes& codes) {
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    const std::uint64_t taken = codes.known[cell];
    known[cell] |= taken;
    occupied[cell] = (occupied[cell] & ~taken) | codes.occupied[cell];
    stairs[cell] = (stairs[cell] & ~taken) | codes.stairs[cell];
  }
  for_each_place(codes.known, [&](std::uint32_t place) { costs[place] = codes.costs[place]; });
}

CodeBlock::CodeBlock(const BlockCodes& codes) : known_(codes.known), occupied_(codes.occupied) {
  const std::uint32_t occupied = count(occupied_);
  const std::size_t stair_bytes = any(codes.stairs) ? (occupied + 7) / 8 : 0;
  attributes_.assign(cost_bytes(occupied) + stair_bytes, 0);
  std::uint32_t rank = 0;
  for_each_place(occupied_, [&](std::uint32_t place) {
    std::uint8_t& pair = attributes_[rank / 2];
    pair = static_cast<std::uint8_t>(pair | (codes.costs[place] & 15) << (rank % 2 * 4));
    if (contains(codes.stairs, place)) {
      std::uint8_t& bits = attributes_[cost_bytes(occupied) + rank / 8];
      bits = static_cast<std::uint8_t>(bits | 1U << rank % 8);
    }
    ++rank;
  });
}

BlockCodes CodeBlock::unpack() const {
  BlockCodes codes;
  codes.known = known_;
  codes.occupied = occupied_;
  const std::size_t stairs_from = cost_bytes(count(occupied_));
  const bool any_stair = attributes_.size() > stairs_from;
  std::uint32_t rank = 0;
  for_each_place(occupied_, [&](std::uint32_t place) {
    codes.costs[place] = attributes_[rank / 2] >> (rank % 2 * 4) & 15;
    if (any_stair && (attributes_[stairs_from + rank / 8] >> rank % 8 & 1) != 0) {
      insert(codes.stairs, place);
    }
    ++rank;
  });
  return codes;
}

VoxelCode CodeBlock::at(std::uint32_t place) const {
  if (!contains(known_, place)) return {};
  return contains(occupied_, place) ? occupied_code(rank_of(place)) : VoxelCode::free();
}

VoxelCode CodeBlock::occupied_code(std::uint32_t rank) const {
  const auto cost = static_cast<CostCode>(attributes_[rank / 2] >> (rank % 2 * 4) & 15);
  const std::size_t stairs_from = cost_bytes(count(occupied_));
  if (attributes_.size() == stairs_from) return VoxelCode::occupied(cost, false);
  return VoxelCode::occupied(cost, (attributes_[stairs_from + rank / 8] >> rank % 8 & 1) != 0);
}

std::uint32_t CodeBlock::rank_of(std::uint32_t place) const {
  const std::size_t cell = place >> 6;
  int rank = std::popcount(occupied_[cell] & ((std::uint64_t{1} << (place & 63)) - 1));
  for (std::size_t before = 0; before < cell; ++before) rank += std::popcount(occupied_[before]);
  return static_cast<std::uint32_t>(rank);
}

}  // namespace warren
