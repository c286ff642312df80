// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/voxel/key.hpp"
#include "core/voxel/morton.hpp"
#include "core/voxel/point.hpp"

namespace warren {

// A position on a ray's way through the lattice. Distances along the ray at which it crosses the
// next voxel borders stand in one ascending table per axis; where two axes cross at once, z goes
// before y before x, as in OctoMap. The voxel is a Morton code, mirrored on the axes along which
// the ray descends: in the mirrored lattice every step is upwards.
struct RayWalker {
  std::uint64_t mirrored = 0;
  std::uint64_t mirror = 0;                  // code = mirrored ^ mirror
  std::array<const double*, 3> crossings{};  // metres, next crossing first
  std::int64_t remaining = 0;                // voxels still to visit, this one included

  std::uint64_t code() const { return mirrored ^ mirror; }

  // To the first voxel outside the block. False, and the position is lost, when the ray ends
  // inside.
  bool leave_block() {
    const std::array<std::uint32_t, 3> border = {crossings_to_border(0), crossings_to_border(1),
                                                 crossings_to_border(2)};
    const double x = crossings[0][border[0] - 1];
    const double y = crossings[1][border[1] - 1];
    const double z = crossings[2][border[2] - 1];
    const Before<false> below;
    const Before<true> up_to;
    if (x < y && x < z) {
      return move({border[0], count(1, x, up_to), count(2, x, up_to)});
    }
    if (y < z) return move({count(0, y, below), border[1], count(2, y, up_to)});
    return move({count(0, z, below), count(1, z, below), border[2]});
  }

 private:
  template <bool kInclusive>
  struct Before {
    bool operator()(double crossing, double limit) const {
      return kInclusive ? crossing <= limit : crossing < limit;
    }
  };

  // Crossings of one axis up to and with the one that leaves the block.
  std::uint32_t crossings_to_border(int axis) const {
    const auto bits = static_cast<std::uint32_t>(mirrored >> axis);
    return 8 - ((bits & 1) | (bits >> 2 & 2) | (bits >> 4 & 4));
  }

  // How many of an axis' next crossings come before the block is left: at most 7 do.
  template <typename IsBefore>
  std::uint32_t count(std::size_t axis, double limit, IsBefore is_before) const {
    std::uint32_t before = 0;
    for (int i = 0; i < kBlockEdge - 1; ++i) {
      before += is_before(crossings[axis][i], limit) ? 1U : 0U;
    }
    return before;
  }

  bool move(const std::array<std::uint32_t, 3>& crossed) {
    for (std::size_t axis = 0; axis < 3; ++axis) crossings[axis] += crossed[axis];
    mirrored = morton_add(mirrored, crossed[0], crossed[1], crossed[2]);
    remaining -= static_cast<std::int64_t>(crossed[0]) + crossed[1] + crossed[2];
    return remaining > 0;
  }
};

// The voxels that a ray passes, from its origin's up to but without its end's: the same as
// octomap::OcTree::computeRayKeys, rounding included. Keeps its tables between rays.
class RayPath {
 public:
  // Distance along a ray to its first border crossing on an axis, and between two.
  struct Spacing {
    double first_m = 0.0;
    double delta_m = 0.0;
  };

  explicit RayPath(const Lattice& lattice) : lattice_(lattice) {}

  // The way from `origin` in voxel `from` to `end` in voxel `to`. The walker reads this object's
  // tables: valid until the next call. No voxels remain when both lie in one voxel.
  RayWalker trace(const Point3f& origin, const VoxelKey& from, const Point3f& end,
                  const VoxelKey& to);

  // The rest of the way of a walker from the last trace(): what to exclusive-or to its code() to
  // get to each next voxel. As many as voxels remain; the last is kEndOfRay. Valid until the next
  // call.
  std::span<const std::uint64_t> unroll(const RayWalker& walker);
  static constexpr std::uint64_t kEndOfRay = std::uint64_t{1} << 63;

  std::size_t memory_bytes() const;

 private:
  struct Axis {
    std::vector<double> crossings;  // ascending, metres; then padding that is never reached
    double per_metre = 0.0;         // crossings per metre; 0 if there are none
    std::size_t within = 0;         // crossings no farther than the ray is long
    std::size_t needed = 0;         // crossings to the end's voxel
    std::size_t used = 0;           // crossings on the way
  };
  void fill(const std::array<Spacing, 3>& spacing, double length_m);
  bool reaches_end() const;
  template <std::size_t kAxis>
  void unroll_axis(const RayWalker& walker);

  Lattice lattice_;
  std::array<Axis, 3> axes_;
  std::vector<std::uint64_t> steps_;
};

}  // namespace warren
