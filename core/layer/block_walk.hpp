// SPDX-License-Identifier: Apache-2.0
#pragma once

// The walks behind block_codec.hpp, for those who bring a coder of their own: whatever offers the
// calls of ModelDecoder.

#include <algorithm>
#include <array>
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
    for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
      if (cells_.at(cell) != DiffState::kMixed) continue;
      code_eight(cubes_, cell * 8, [&](auto... told) { code_cube(told...); });
    }
    for (std::uint32_t cube = 0; cube < kCellsPerBlock * 8; ++cube) {
      if (cubes_.at(cube) != DiffState::kMixed) continue;
      code_eight(voxels_, cube * 8, [&](auto... told) { code_voxel(told...); });
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

  // Calls code(part, before, is_last) for the eight parts of a mixed one, in order. `before` is the
  // state of all parts before, from the fifth on; "mixed" if they are not alike.
  template <std::uint32_t kEdge, typename Code>
  static void code_eight(const PaddedGrid<DiffState, kEdge>& parts, std::uint32_t first,
                         Code&& code) {
    for (std::uint32_t i = 0; i < 4; ++i) code(first + i, DiffState::kMixed, false);
    DiffState before = parts.at(first);
    const auto compare = [&](std::uint32_t i) {
      if (parts.at(first + i) != before) before = DiffState::kMixed;
    };
    for (std::uint32_t i = 1; i < 4; ++i) compare(i);
    for (std::uint32_t i = 4; i < 8; ++i) {
      code(first + i, before, i == 7);
      compare(i);
    }
  }

  static std::size_t neighbourhood(std::size_t face_states, DiffState before) {
    return face_states + (before != DiffState::kMixed ? kFaceNeighbourhoods : 0);
  }
  // The three parts below the last are among those before.
  static std::size_t last_neighbourhood(std::size_t face_states, DiffState before) {
    return static_cast<std::size_t>(before) << 6 | face_states >> 6;
  }

  void code_cube(std::uint32_t cube, DiffState before, bool is_last) {
    const std::size_t faces = cubes_.face_states(cube);
    const DiffState told = cube_state(codes_, cube);
    const DiffState state =
        is_last && before != DiffState::kMixed
            ? code_last_cube(kLastCube + last_neighbourhood(faces, before) * (kStateBits - 1),
                             before, told)
            : code_state(kCube + neighbourhood(faces, before) * kStateBits, told);
    if (state != DiffState::kMixed) spread_to_cube(cube, state);
  }

  void spread_to_cube(std::uint32_t cube, DiffState state) {
    cubes_.at(cube) = state;
    for (std::uint32_t place = cube * 8; place < cube * 8 + 8; ++place) voxels_.at(place) = state;
    store(cube * 8, 0xFF, state);
  }

  void code_voxel(std::uint32_t place, DiffState before, bool is_last) {
    const std::size_t faces = voxels_.face_states(place);
    const DiffState told = voxel_state(codes_, place);
    const DiffState state =
        is_last && before != DiffState::kMixed
            ? code_other(kLastVoxel + last_neighbourhood(faces, before), before, told)
            : code_whole(kVoxel + neighbourhood(faces, before) * (kStateBits - 1), told);
    voxels_.at(place) = state;
    store(place, 1, state);
  }

  DiffState code_state(std::size_t context, DiffState told) {
    if (coder_.bit(context, told == DiffState::kUnchanged)) return DiffState::kUnchanged;
    if (coder_.bit(context + 1, told == DiffState::kMixed)) return DiffState::kMixed;
    return coder_.bit(context + 2, told == DiffState::kOccupied) ? DiffState::kOccupied
                                                                 : DiffState::kFree;
  }
  DiffState code_whole(std::size_t context, DiffState told) {
    if (coder_.bit(context, told == DiffState::kUnchanged)) return DiffState::kUnchanged;
    return coder_.bit(context + 1, told == DiffState::kOccupied) ? DiffState::kOccupied
                                                                 : DiffState::kFree;
  }
  DiffState code_last_cube(std::size_t context, DiffState excluded, DiffState told) {
    if (coder_.bit(context, told == DiffState::kMixed)) return DiffState::kMixed;
    return code_other(context + 1, excluded, told);
  }
  // One of the two states, not mixed, that are not excluded.
  DiffState code_other(std::size_t context, DiffState excluded, DiffState told) {
    const DiffState low =
        excluded == DiffState::kUnchanged ? DiffState::kFree : DiffState::kUnchanged;
    const DiffState high =
        excluded == DiffState::kOccupied ? DiffState::kFree : DiffState::kOccupied;
    return coder_.bit(context, told == high) ? high : low;
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
  std::uint32_t cost_sum = 0;  // weighted: 3 across a face, 2 an edge, 1 a corner
  std::uint32_t weight_sum = 0;
  std::uint32_t cost_low = 15;
  std::uint32_t cost_high = 0;

  void add(Attributes attributes, std::uint32_t axes_apart) {
    if (attributes == kNotTold) return;
    stairs += attributes >> 4;
    const std::uint32_t cost = attributes & 15;
    if (cost == kNoCostData) {
      ++without_data;
      return;
    }
    ++with_data;
    const std::uint32_t weight = 4 - axes_apart;
    weight_sum += weight;
    cost_sum += cost * weight;
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
    const std::size_t mean_in_halves = (2 * cost_sum + weight_sum / 2) / weight_sum;
    return kCost + (mean_in_halves * kCostSpreads + spread()) * kCostTree;
  }
  std::size_t spread() const {
    constexpr std::array<std::uint8_t, 16> kOfRange = {2, 3, 4, 5, 5, 6, 6, 6,
                                                       6, 6, 6, 6, 6, 6, 6, 6};
    const std::uint32_t range = cost_high - cost_low;
    return range == 0 && with_data <= 2 ? with_data - 1 : kOfRange[range];
  }
};

template <typename Coder>
void code_attributes(Coder& coder, const PastNeighbours& past, BlockCodes& codes) {
  if (!any(codes.occupied)) return;
  PaddedGrid<Attributes, 8> told{kNotTold};
  for (std::size_t axis = 0; axis < past.size(); ++axis) {
    if (past[axis] != nullptr) told.fill_past_face(axis, past[axis], attributes_of);
  }
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(codes.occupied[cell], [&](std::uint32_t bit) {
      const std::uint32_t place = cell << 6 | bit;
      NeighbourSummary around;
      told.for_each_coded(place, [&](Attributes attributes, std::uint32_t axes_apart) {
        around.add(attributes, axes_apart);
      });
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
