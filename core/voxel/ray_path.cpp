// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/ray_path.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace warren {
namespace {

constexpr double kNever = std::numeric_limits<double>::max();
constexpr std::size_t kPadding = 8;  // RayWalker::leave_cube reads this far ahead
// Rounding may carry a ray past its end's voxel by one border; beyond that nothing is looked at.
constexpr std::size_t kOvershoot = 2;

}  // namespace

RayWalker RayPath::trace(const Point3f& origin, const VoxelKey& from, const Point3f& end,
                         const VoxelKey& to) {
  RayWalker walker;
  if (from == to) return walker;

  // Mixed float and double on purpose: the very roundings of the oracle.
  const std::array<float, 3> start = {origin.x, origin.y, origin.z};
  std::array<float, 3> direction = {end.x - origin.x, end.y - origin.y, end.z - origin.z};
  const float squared =
      direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
  const auto length = static_cast<float>(std::sqrt(static_cast<double>(squared)));
  const std::array<std::int32_t, 3> first_key = {from.x, from.y, from.z};
  const std::array<std::int32_t, 3> last_key = {to.x, to.y, to.z};
  const double resolution = lattice_.resolution_m();
  for (std::size_t i = 0; i < 3; ++i) {
    direction[i] /= length;
    const int step = direction[i] > 0.0F ? 1 : direction[i] < 0.0F ? -1 : 0;
    axes_[i].needed = static_cast<std::size_t>(std::abs(last_key[i] - first_key[i]));
    double first = kNever;
    double delta = kNever;
    if (step != 0) {
      const double border = lattice_.centre_m(first_key[i]) +
                            static_cast<double>(static_cast<float>(step * resolution * 0.5));
      first = (border - static_cast<double>(start[i])) / static_cast<double>(direction[i]);
      delta = resolution / static_cast<double>(std::fabs(direction[i]));
    }
    if (step < 0) walker.mirror |= kMortonAxis[i];
    fill(axes_[i], first, delta, static_cast<double>(length));
    walker.crossings[i] = axes_[i].crossings.data();
  }
  walker.mirrored = morton_of(from) ^ walker.mirror;
  walker.remaining = voxels_passed();
  return walker;
}

void RayPath::fill(Axis& axis, double first_m, double delta_m, double length_m) {
  const std::size_t most = axis.needed + kOvershoot;
  if (axis.crossings.size() < most + kPadding) axis.crossings.resize(most + kPadding);
  double* const crossings = axis.crossings.data();
  std::size_t count = 0;
  // Repeated addition, not multiplication: the same sums as the oracle's.
  for (double crossing = first_m; crossing <= length_m && count < most; crossing += delta_m) {
    crossings[count++] = crossing;
  }
  axis.within = count;
  for (std::size_t i = 0; i < kPadding; ++i) crossings[count + i] = kNever;
}

bool RayPath::reaches_end() const {
  for (const Axis& axis : axes_) {
    if (axis.within < axis.needed) return false;
  }
  // Past its end's layer on one axis before the last needed crossing of another: missed.
  for (std::size_t over = 0; over < 3; ++over) {
    if (axes_[over].within == axes_[over].needed) continue;
    const double past = axes_[over].crossings[axes_[over].needed];
    for (std::size_t other = 0; other < 3; ++other) {
      if (other == over || axes_[other].needed == 0) continue;
      const double last = axes_[other].crossings[axes_[other].needed - 1];
      if (past < last || (past == last && over > other)) return false;
    }
  }
  return true;
}

std::int64_t RayPath::voxels_passed() const {
  const bool reaches = reaches_end();
  std::size_t crossings = 0;
  for (const Axis& axis : axes_) crossings += reaches ? axis.needed : axis.within;
  return crossings == 0 ? 1
                        : static_cast<std::int64_t>(crossings);  // the first voxel always counts
}

std::size_t RayPath::memory_bytes() const {
  std::size_t bytes = 0;
  for (const Axis& axis : axes_) bytes += axis.crossings.capacity() * sizeof(double);
  return bytes;
}

}  // namespace warren
