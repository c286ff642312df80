// SPDX-License-Identifier: Apache-2.0
#pragma once

// The walks behind block_codec.hpp, for those who bring a coder of their own: whatever offers the
// calls of ModelDecoder.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/layer/block_codec.hpp"
#include "core/layer/padded_grid.hpp"
#include "core/voxel/bits.hpp"
#include "core/voxel/morton.hpp"

namespace warren {
namespace block_walk {

using namespace diff_context;

// The state of a part of a block whose voxels fill `full`.
template <typename Word>
constexpr DiffState state_of(Word known, Word occupied) {
  constexpr auto kFull = static_cast<Word>(~Word{0});
  if (known == 0) return DiffState::kUnchanged;
  if (known != kFull) return DiffState::kMixed;
  if (occupied == 0) return DiffState::kFree;
  return occupied == kFull ? DiffState::kOccupied : DiffState::kMixed;
}

constexpr std::uint8_t cube_of(const VoxelMask& mask, std::uint32_t cube) {
  return static_cast<std::uint8_t>(mask[cube >> 3] >> (cube & 7) * 8);
}

inline DiffState cell_state(const BlockCodes& codes, std::uint32_t cell) {
  return state_of(codes.known[cell], codes.occupied[cell]);
}
inline DiffState cube_state(const BlockCodes& codes, std::uint32_t cube) {
  return state_of(cube_of(codes.known, cube), cube_of(codes.occupied, cube));
}
inline DiffState voxel_state(const BlockCodes& codes, std::uint32_t place) {
  if (!contains(codes.known, place)) return DiffState::kUnchanged;
  return contains(codes.occupied, place) ? DiffState::kOccupied : DiffState::kFree;
}

inline void set_bits(VoxelMask& mask, std::uint32_t first_place, std::uint64_t bits, bool value) {
  const std::uint64_t shifted = bits << (first_place & 63);
  std::uint64_t& cell = mask[first_place >> 6];
  cell = value ? cell | shifted : cell & ~shifted;
}

// What is told so far of the states in and around a block, at three sizes of parts. "Mixed" where
// nothing is told yet.
template <typename Coder>
class StateWalk {
 public:
  StateWalk(Coder& coder, const PastNeighbours& past, BlockCodes& codes)
      : coder_(coder), codes_(codes) {
    for (std::size_t axis = 0; axis < past.size(); ++axis) {
      cells_.fill_past_face(axis, past[axis], cell_state);
      cubes_.fill_past_face(axis, past[axis], cube_state);
      voxels_.fill_past_face(axis, past[axis], voxel_state);
    }
  }

  void run() {
    for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) code_cell(cell);
    for (std::uint32_t cube = 0; cube < kCellsPerBlock * 8; ++cube) {
      if (cells_.at(cube >> 3) == DiffState::kMixed) code_cube(cube);
    }
    for (std::uint32_t cube = 0; cube < kCellsPerBlock * 8; ++cube) {
      if (cubes_.at(cube) != DiffState::kMixed) continue;
      for (std::uint32_t place = cube * 8; place < cube * 8 + 8; ++place) code_voxel(place);
    }
  }

 private:
  void code_cell(std::uint32_t cell) {
    const std::size_t context = kCell + cells_.past_states(cell) * kStateBits;
    const DiffState state = code_state(context, cell_state(codes_, cell));
    cells_.at(cell) = state;
    if (state == DiffState::kMixed) return;
    for (std::uint32_t cube = cell * 8; cube < cell * 8 + 8; ++cube) spread_to_cube(cube, state);
  }

  void code_cube(std::uint32_t cube) {
    const std::size_t context = kCube + cubes_.face_states(cube) * kStateBits;
    const DiffState state = code_state(context, cube_state(codes_, cube));
    if (state != DiffState::kMixed) spread_to_cube(cube, state);
  }

  void spread_to_cube(std::uint32_t cube, DiffState state) {
    cubes_.at(cube) = state;
    for (std::uint32_t place = cube * 8; place < cube * 8 + 8; ++place) voxels_.at(place) = state;
    store(cube * 8, 0xFF, state);
  }

  void code_voxel(std::uint32_t place) {
    const std::size_t context = kVoxel + voxels_.face_states(place) * (kStateBits - 1);
    const DiffState told = voxel_state(codes_, place);
    DiffState state = DiffState::kUnchanged;
    if (!coder_.bit(context, told == DiffState::kUnchanged)) {
      const bool occupied = coder_.bit(context + 1, told == DiffState::kOccupied);
      state = occupied ? DiffState::kOccupied : DiffState::kFree;
    }
    voxels_.at(place) = state;
    store(place, 1, state);
  }

  DiffState code_state(std::size_t context, DiffState told) {
    if (coder_.bit(context, told == DiffState::kUnchanged)) return DiffState::kUnchanged;
    if (coder_.bit(context + 1, told == DiffState::kMixed)) return DiffState::kMixed;
    return coder_.bit(context + 2, told == DiffState::kOccupied) ? DiffState::kOccupied
                                                                 : DiffState::kFree;
  }

  void store(std::uint32_t first_place, std::uint64_t bits, DiffState state) {
    if constexpr (Coder::kReads) {
      set_bits(codes_.known, first_place, bits, state != DiffState::kUnchanged);
      set_bits(codes_.occupied, first_place, bits, state == DiffState::kOccupied);
    }
  }

  Coder& coder_;
  BlockCodes& codes_;
  PaddedGrid<DiffState, 2> cells_{DiffState::kMixed};
  PaddedGrid<DiffState, 4> cubes_{DiffState::kMixed};
  PaddedGrid<DiffState, 8> voxels_{DiffState::kMixed};
};

// Of an occupied voxel: bits 0 to 3 its cost code, bit 4 stair. Told of nothing else.
using Attributes = std::uint8_t;
inline constexpr Attributes kNotTold = 0xFF;

inline Attributes attributes_of(const BlockCodes& codes, std::uint32_t place) {
  if (!contains(codes.occupied, place)) return kNotTold;
  return static_cast<Attributes>(codes.costs[place] | (contains(codes.stairs, place) ? 16 : 0));
}

struct NeighbourSummary {
  std::uint32_t stairs = 0;
  std::uint32_t without_data = 0;
  std::uint32_t with_data = 0;
  std::uint32_t cost_sum = 0;
  std::uint32_t cost_low = 15;
  std::uint32_t cost_high = 0;

  void add(Attributes attributes) {
    if (attributes == kNotTold) return;
    stairs += attributes >> 4;
    const std::uint32_t cost = attributes & 15;
    if (cost == kNoCostData) {
      ++without_data;
      return;
    }
    ++with_data;
    cost_sum += cost;
    cost_low = std::min(cost_low, cost);
    cost_high = std::max(cost_high, cost);
  }

  std::size_t stair_context() const {
    return kStair + (with_data + without_data == 0 ? 3 : std::min(stairs, 2U));
  }
  std::size_t no_data_context() const {
    return kNoData + std::min(with_data, 2U) * std::size_t{3} + std::min(without_data, 2U);
  }
  std::size_t cost_context() const {
    if (with_data == 0) return kCost;
    const std::size_t mean = (cost_sum + with_data / 2) / with_data;
    const std::uint32_t range = cost_high - cost_low;
    const std::size_t spread = with_data == 1 ? 0 : range == 0 ? 1 : range <= 2 ? 2 : 3;
    return kCost + (mean * kCostSpreads + spread) * kCostTree;
  }
};

template <typename Coder>
void code_attributes(Coder& coder, const PastNeighbours& past, BlockCodes& codes) {
  PaddedGrid<Attributes, 8> told{kNotTold};
  for (std::size_t axis = 0; axis < past.size(); ++axis) {
    if (past[axis] != nullptr) told.fill_past_face(axis, past[axis], attributes_of);
  }
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(codes.occupied[cell], [&](std::uint32_t bit) {
      const std::uint32_t place = cell << 6 | bit;
      NeighbourSummary around;
      told.for_each_around(place, [&](Attributes attributes) { around.add(attributes); });
      const bool stair = coder.bit(around.stair_context(), contains(codes.stairs, place));
      CostCode cost = kNoCostData;
      if (!coder.bit(around.no_data_context(), codes.costs[place] == kNoCostData)) {
        cost =
            static_cast<CostCode>(code_tree(coder, around.cost_context(), 4, codes.costs[place]));
      }
      if constexpr (Coder::kReads) {
        codes.costs[place] = cost;
        if (stair) insert(codes.stairs, place);
      }
      told.at(place) = static_cast<Attributes>(cost | (stair ? 16 : 0));
    });
  }
}

}  // namespace block_walk

template <typename Coder>
void code_voxels(Coder& coder, const PastNeighbours& past, BlockCodes& codes) {
  block_walk::StateWalk<Coder>(coder, past, codes).run();
  block_walk::code_attributes(coder, past, codes);
}

template <typename Coder>
void code_voxels_raw(Coder& coder, BlockCodes& codes) {
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const VoxelCode told = codes.at(place);
    VoxelCode code;
    if (coder.even_bit(told.state() == VoxelState::kOccupied)) {
      const bool stair = coder.even_bit(told.stair());
      std::uint32_t cost = 0;
      for (int i = 3; i >= 0; --i) {
        cost = cost << 1 | (coder.even_bit((told.cost() >> i & 1) != 0) ? 1U : 0U);
      }
      code = VoxelCode::occupied(static_cast<CostCode>(cost), stair);
    } else if (coder.even_bit(told.state() == VoxelState::kFree)) {
      code = VoxelCode::free();
    }
    if constexpr (Coder::kReads) codes.set(place, code);
  }
}

}  // namespace warren
