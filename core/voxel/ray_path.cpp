// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/ray_path.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace warren {
namespace {

constexpr double kNever = std::numeric_limits<double>::max();
constexpr std::size_t kPadding = 8;  // RayWalker::leave_block reads this far ahead
// Rounding may carry a ray past its end's voxel by one border; beyond that nothing is looked at.
constexpr std::size_t kOvershoot = 2;

// Bits of a coordinate that adding one flips, spread for a Morton code; by its trailing ones.
template <std::size_t kAxis>
constexpr auto kFlips = [] {
  std::array<std::uint64_t, 17> flips{};
  for (std::size_t ones = 0; ones < 16; ++ones) {
    flips[ones] = morton_spread((std::uint64_t{2} << ones) - 1) << kAxis;
  }
  return flips;
}();

// Counts how many crossings of one axis come before each of another's, in turn; those at the same
// distance too if kTiesCount.
template <bool kTiesCount>
class RankIn {
 public:
  // The other axis' crossings start at `first_m` and come every `step_m`.
  RankIn(const double* crossings, double per_metre, double first_m, double step_m)
      : crossings_(crossings),
        guess_((first_m - crossings[0]) * per_metre + 1.0 - kMargin),
        per_step_(step_m * per_metre) {}

  std::size_t next(double distance_m) {
    // Low by the margin, so that the truth is the guess or one more: the table decides.
    const double guess = guess_ > 0.0 ? guess_ : 0.0;
    const auto index = static_cast<std::size_t>(static_cast<std::int64_t>(guess));
    guess_ += per_step_;
    const bool one_more =
        kTiesCount ? crossings_[index] <= distance_m : crossings_[index] < distance_m;
    return index + (one_more ? 1 : 0);
  }

 private:
  // Far more than the roundings of 65536 sums, far less than one crossing.
  static constexpr double kMargin = 1e-3;

  const double* crossings_;
  double guess_;
  double per_step_;
};

// Where a ray crosses voxel borders along one axis, in the roundings of the oracle.
RayPath::Spacing spacing_of(std::int32_t key, float start_m, float direction,
                            const Lattice& lattice) {
  if (!(direction > 0.0F) && !(direction < 0.0F)) return {kNever, kNever};
  const double half_step = (direction > 0.0F ? 0.5 : -0.5) * lattice.resolution_m();
  const double border = lattice.centre_m(key) + static_cast<double>(static_cast<float>(half_step));
  return {(border - static_cast<double>(start_m)) / static_cast<double>(direction),
          lattice.resolution_m() / static_cast<double>(std::fabs(direction))};
}

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
  std::array<Spacing, 3> spacing;
  for (std::size_t i = 0; i < 3; ++i) {
    direction[i] /= length;
    axes_[i].needed = static_cast<std::size_t>(std::abs(last_key[i] - first_key[i]));
    spacing[i] = spacing_of(first_key[i], start[i], direction[i], lattice_);
    if (direction[i] < 0.0F) walker.mirror |= kMortonAxis[i];
  }
  fill(spacing, static_cast<double>(length));
  for (std::size_t i = 0; i < 3; ++i) walker.crossings[i] = axes_[i].crossings.data();
  walker.mirrored = morton_of(from) ^ walker.mirror;
  const bool reaches = reaches_end();
  for (Axis& axis : axes_) {
    axis.used = reaches ? axis.needed : axis.within;
    walker.remaining += static_cast<std::int64_t>(axis.used);
  }
  if (walker.remaining == 0) walker.remaining = 1;  // the first voxel always counts
  return walker;
}

void RayPath::fill(const std::array<Spacing, 3>& spacing, double length_m) {
  const std::size_t count =
      std::max({axes_[0].needed, axes_[1].needed, axes_[2].needed}) + kOvershoot;
  for (Axis& axis : axes_) {
    if (axis.crossings.size() < count + kPadding) axis.crossings.resize(count + kPadding);
  }
  double* const xs = axes_[0].crossings.data();
  double* const ys = axes_[1].crossings.data();
  double* const zs = axes_[2].crossings.data();
  double x = spacing[0].first_m;
  double y = spacing[1].first_m;
  double z = spacing[2].first_m;
  // Repeated addition, not multiplication: the same sums as the oracle's. All three axes at once:
  // each sum waits for the one before.
  for (std::size_t i = 0; i < count; ++i) {
    xs[i] = x;
    ys[i] = y;
    zs[i] = z;
    x += spacing[0].delta_m;
    y += spacing[1].delta_m;
    z += spacing[2].delta_m;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    axis.within = axis.needed + kOvershoot;
    while (axis.within > 0 && !(axis.crossings[axis.within - 1] <= length_m)) --axis.within;
    axis.per_metre = axis.within > 0 ? 1.0 / spacing[i].delta_m : 0.0;
    std::fill_n(axis.crossings.begin() + static_cast<std::ptrdiff_t>(axis.within), kPadding,
                kNever);
  }
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

std::span<const std::uint64_t> RayPath::unroll(const RayWalker& walker) {
  const auto count = static_cast<std::size_t>(walker.remaining);
  if (steps_.size() < count) steps_.resize(count);
  unroll_axis<0>(walker);
  unroll_axis<1>(walker);
  unroll_axis<2>(walker);
  steps_[count - 1] = kEndOfRay;
  return {steps_.data(), count};
}

// Puts each crossing of one axis at its rank among the crossings of all three. No crossing waits
// for another, as it would in a merge: that is what makes it fast.
template <std::size_t kAxis>
void RayPath::unroll_axis(const RayWalker& walker) {
  constexpr std::size_t kNext = (kAxis + 1) % 3;
  constexpr std::size_t kLast = (kAxis + 2) % 3;
  const double* const crossings = walker.crossings[kAxis];
  const auto passed = static_cast<std::size_t>(crossings - axes_[kAxis].crossings.data());
  const std::size_t count = axes_[kAxis].used - passed;
  if (count == 0) return;
  const double step_m = 1.0 / axes_[kAxis].per_metre;
  RankIn<(kNext > kAxis)> next(walker.crossings[kNext], axes_[kNext].per_metre, crossings[0],
                               step_m);
  RankIn<(kLast > kAxis)> last(walker.crossings[kLast], axes_[kLast].per_metre, crossings[0],
                               step_m);
  const auto coordinate = static_cast<std::uint32_t>(morton_compact(walker.mirrored >> kAxis));
  std::uint64_t* const steps = steps_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t rank = i + next.next(crossings[i]) + last.next(crossings[i]);
    const std::uint32_t not_ones = ~(coordinate + static_cast<std::uint32_t>(i));  // never 0
    steps[rank] = kFlips<kAxis>[static_cast<std::size_t>(__builtin_ctz(not_ones))];
  }
}

std::size_t RayPath::memory_bytes() const {
  std::size_t bytes = 0;
  for (const Axis& axis : axes_) bytes += axis.crossings.capacity() * sizeof(double);
  return bytes + steps_.capacity() * sizeof(std::uint64_t);
}

}  // namespace warren
