// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/layer/code_block.hpp"
#include "core/voxel/morton.hpp"

namespace warren {

// The parts of a block, kEdge along each axis, and one layer of parts around them. Parts of the
// block are numbered in Morton order.
template <typename Value, std::uint32_t kEdge>
class PaddedGrid {
 public:
  static constexpr std::uint32_t kParts = kEdge * kEdge * kEdge;

  explicit PaddedGrid(Value fill) { values_.fill(fill); }

  Value& at(std::uint32_t part) { return values_[kPlaces[part]]; }
  Value at(std::uint32_t part) const { return values_[kPlaces[part]]; }

  // The face towards the block below along the axis gets value_of(neighbour, part) of the parts
  // that touch it; Value{} if there is no such block.
  template <typename ValueOf>
  void fill_past_face(std::size_t axis, const BlockCodes* neighbour, ValueOf&& value_of) {
    const std::uint32_t last = kAxisBits[axis];
    for (std::uint32_t part = last; part < kParts; part = (part + 1) | last) {
      Value* const inside = &values_[kPlaces[part & ~last]];
      *(inside - kSteps[axis]) = neighbour != nullptr ? value_of(*neighbour, part) : Value{};
    }
  }

  // Two bits per face: those below along x, y, z; then, if all six are asked for, those above.
  std::size_t past_states(std::uint32_t part) const {
    const Value* const here = &values_[kPlaces[part]];
    return states(here - kSteps[0], here - kSteps[1], here - kSteps[2]);
  }
  std::size_t face_states(std::uint32_t part) const {
    const Value* const here = &values_[kPlaces[part]];
    return past_states(part) | states(here + kSteps[0], here + kSteps[1], here + kSteps[2]) << 6;
  }

  // Calls visit(value, axes_apart) for the parts around, 1 across a face, 2 an edge, 3 a corner,
  // but for those that are above along some axes and below along none: in Morton order they come
  // later.
  template <typename Visit>
  void for_each_coded(std::uint32_t part, Visit&& visit) const {
    const Value* const here = &values_[kPlaces[part]];
    for (std::ptrdiff_t z = -1; z <= 1; ++z) {
      for (std::ptrdiff_t y = -1; y <= 1; ++y) {
        const Value* const row = here + z * kSteps[2] + y * kSteps[1];
        const std::uint32_t axes_apart = (y != 0 ? 1U : 0U) + (z != 0 ? 1U : 0U);
        visit(row[-1], axes_apart + 1);
        if (y >= 0 && z >= 0) continue;
        visit(row[0], axes_apart);
        visit(row[1], axes_apart + 1);
      }
    }
  }

 private:
  static constexpr std::ptrdiff_t kWidth = kEdge + 2;
  static constexpr std::array<std::ptrdiff_t, 3> kSteps = {1, kWidth, kWidth* kWidth};
  // All bits of a part's number that tell of one axis.
  static constexpr std::array<std::uint32_t, 3> kAxisBits = {
      0x49 & (kParts - 1), 0x92 & (kParts - 1), 0x124 & (kParts - 1)};

  static constexpr std::array<std::uint16_t, kParts> make_places() {
    std::array<std::uint16_t, kParts> places{};
    for (std::uint32_t part = 0; part < kParts; ++part) {
      const VoxelKey at = place_of_morton9(part);
      places[part] = static_cast<std::uint16_t>((at.x + 1) * kSteps[0] + (at.y + 1) * kSteps[1] +
                                                (at.z + 1) * kSteps[2]);
    }
    return places;
  }
  static constexpr std::array<std::uint16_t, kParts> kPlaces = make_places();

  static std::size_t states(const Value* x, const Value* y, const Value* z) {
    return static_cast<std::size_t>(*x) | static_cast<std::size_t>(*y) << 2 |
           static_cast<std::size_t>(*z) << 4;
  }

  std::array<Value, kWidth * kWidth * kWidth> values_;
};

}  // namespace warren
