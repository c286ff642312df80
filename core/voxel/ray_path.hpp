// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/voxel/key.hpp"
#include "core/voxel/point.hpp"

namespace warren {

// A position on a ray's way through the lattice. Distances along the ray at which it crosses the
// next voxel borders stand in one ascending table per axis; where two axes cross at once, z goes
// before y before x, as in OctoMap.
struct RayWalker {
  std::array<std::int32_t, 3> key{};
  std::array<std::int32_t, 3> step{};        // -1, 0, 1
  std::array<const double*, 3> crossings{};  // next crossing first
  std::int64_t remaining = 0;                // voxels still to visit, this one included

  // To the next voxel on the ray.
  void advance() {
    const std::size_t axis = next_axis(*crossings[0], *crossings[1], *crossings[2]);
    key[axis] += step[axis];
    ++crossings[axis];
    --remaining;
  }

  // To the first voxel outside the aligned cube of kEdge (4 or 8) voxels. False, and the position
  // is lost, when the ray ends inside.
  template <int kEdge>
  bool leave_cube() {
    std::array<std::int32_t, 3> border{};  // crossings up to and with the one that leaves the cube
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t inside = key[axis] & (kEdge - 1);
      border[axis] = step[axis] > 0 ? kEdge - inside : inside + 1;
    }
    const std::size_t exit = next_axis(crossings[0][border[0] - 1], crossings[1][border[1] - 1],
                                       crossings[2][border[2] - 1]);
    const double exit_m = crossings[exit][border[exit] - 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t crossed = axis == exit  ? border[axis]
                                   : axis > exit ? count_up_to<kEdge>(crossings[axis], exit_m)
                                                 : count_below<kEdge>(crossings[axis], exit_m);
      key[axis] += crossed * step[axis];
      crossings[axis] += crossed;
      remaining -= crossed;
    }
    return remaining > 0;
  }

 private:
  static std::size_t next_axis(double x, double y, double z) {
    if (x < y) return x < z ? 0 : 2;
    return y < z ? 1 : 2;
  }
  // How many of the next crossings come before the cube is left; fewer than kEdge do.
  template <int kEdge>
  static std::int32_t count_below(const double* next, double limit) {
    std::int32_t count = 0;
    for (int i = 0; i < kEdge - 1; ++i) count += next[i] < limit ? 1 : 0;
    return count;
  }
  template <int kEdge>
  static std::int32_t count_up_to(const double* next, double limit) {
    std::int32_t count = 0;
    for (int i = 0; i < kEdge - 1; ++i) count += next[i] <= limit ? 1 : 0;
    return count;
  }
};

// The voxels that a ray passes, from its origin's up to but without its end's: the same as
// octomap::OcTree::computeRayKeys, rounding included. Keeps its tables between rays.
class RayPath {
 public:
  explicit RayPath(const Lattice& lattice) : lattice_(lattice) {}

  // The way from `origin` in voxel `from` to `end` in voxel `to`. The walker reads this object's
  // tables: valid until the next call. No voxels remain when both lie in one voxel.
  RayWalker trace(const Point3f& origin, const VoxelKey& from, const Point3f& end,
                  const VoxelKey& to);

  std::size_t memory_bytes() const;

 private:
  struct Axis {
    std::vector<double> crossings;  // ascending, then padding that is never reached
    std::size_t within = 0;         // crossings no farther than the ray is long
    std::size_t needed = 0;         // crossings to the end's voxel
  };
  void fill(Axis& axis, double first_m, double delta_m, double length_m);
  bool reaches_end() const;
  std::int64_t voxels_passed() const;

  Lattice lattice_;
  std::array<Axis, 3> axes_;
};

}  // namespace warren
