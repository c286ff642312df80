// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/voxel/key.hpp"

namespace warren {

// Voxels along a ray in order, with the distance at which each is entered (Amanatides and Woo). May
// run out of the key space.
class VoxelRay {
 public:
  // `start` is the voxel of `origin`; `unit` is of unit length.
  VoxelRay(const Lattice& lattice, const VoxelKey& start, const std::array<double, 3>& origin,
           const std::array<double, 3>& unit)
      : key_{start.x, start.y, start.z} {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (unit[axis] == 0.0) continue;
      step_[axis] = unit[axis] > 0.0 ? 1 : -1;
      const double border =
          lattice.centre_m(key_[axis]) + 0.5 * step_[axis] * lattice.resolution_m();
      next_m_[axis] = std::max(0.0, (border - origin[axis]) / unit[axis]);
      delta_m_[axis] = lattice.resolution_m() / std::abs(unit[axis]);
    }
  }

  VoxelKey key() const { return {key_[0], key_[1], key_[2]}; }
  double entered_m() const { return entered_m_; }
  bool in_key_space() const {
    return std::all_of(key_.begin(), key_.end(),
                       [](std::int32_t axis) { return axis >= kKeyMin && axis <= kKeyMax; });
  }
  void advance() {
    const auto axis = static_cast<std::size_t>(std::min_element(next_m_.begin(), next_m_.end()) -
                                               next_m_.begin());
    entered_m_ = next_m_[axis];
    key_[axis] += step_[axis];
    next_m_[axis] += delta_m_[axis];
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  std::array<std::int32_t, 3> key_;
  std::array<std::int32_t, 3> step_{};
  std::array<double, 3> next_m_{kNever, kNever, kNever};
  std::array<double, 3> delta_m_{kNever, kNever, kNever};
  double entered_m_ = 0.0;
};

}  // namespace warren
