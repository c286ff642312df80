// SPDX-License-Identifier: Apache-2.0
#include "tools/world/rock_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/world/noise.hpp"

namespace warren::world {
namespace {

constexpr double kCell_m = 3.0;  // of the index
// How far beyond its walls a passage is known to the index. may_cross() asks that far.
constexpr double kReach_m = 2.4;
constexpr double kFloorNormal = 0.7;

std::uint64_t key_of(const Eigen::Vector3i& cell) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = (key << 21) | static_cast<std::uint64_t>(cell[axis] + (1 << 20));
  return key;
}

Eigen::Vector3i cell_of(const Eigen::Vector3d& position) {
  return (position / kCell_m).array().floor().cast<int>();
}

// Polynomial smooth minimum: differs from the minimum only where both are within `k`.
double smooth_min(double a, double b, double k) {
  const double overlap = std::max(0.0, k - std::abs(a - b));
  return std::min(a, b) - overlap * overlap / (4.0 * k);
}
double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

// The passage's cross-section nearest to a point.
struct Slice {
  double aside_m;  // level distance from the floor line
  double above_m;  // the floor line, below zero under it
  double half_width_m;
  double height_m;
  double floor_z;
  double beyond_m;  // an end, along the floor line in plan; below zero between the ends
};

Slice slice_at(const Passage& passage, const Eigen::Vector3d& position) {
  const Eigen::Vector3d& a = passage.from.floor;
  const Eigen::Vector3d along = passage.to.floor - a;
  const double length2 = along.head<2>().squaredNorm();
  const double share =
      length2 < 1e-12 ? 0.0 : (position - a).head<2>().dot(along.head<2>()) / length2;
  const double t = std::clamp(share, 0.0, 1.0);
  const auto blend = [t](double from, double to) { return from + t * (to - from); };
  Slice slice{};
  slice.aside_m = (position - a - t * along).head<2>().norm();
  slice.floor_z = a.z() + t * along.z();
  slice.above_m = position.z() - slice.floor_z;
  slice.half_width_m = blend(passage.from.half_width_m, passage.to.half_width_m);
  slice.height_m = blend(passage.from.height_m, passage.to.height_m);
  slice.beyond_m = std::max(-share, share - 1.0) * std::sqrt(length2);
  return slice;
}

// An ellipse about a point above the floor, so that the floor cuts it where it still is wide.
double oval_distance(const Slice& slice) {
  constexpr double kMiddle = 0.4;
  const double half_height_m = slice.height_m * (1.0 - kMiddle);
  const double squash = slice.half_width_m / half_height_m;
  const double up = (slice.above_m - slice.height_m * kMiddle) * squash;
  const double stretched = std::sqrt(slice.aside_m * slice.aside_m + up * up) - slice.half_width_m;
  return stretched * std::min(1.0, 1.0 / squash);
}

double drift_distance(const Slice& slice) {
  const double rounding = 0.35 * std::min(slice.half_width_m, slice.height_m / 2.0);
  const double aside = slice.aside_m - slice.half_width_m + rounding;
  // The lower half reaches below the floor, which cuts it: no rounding down there.
  const double above = std::abs(slice.above_m) - slice.height_m + rounding;
  const double outside = std::hypot(std::max(aside, 0.0), std::max(above, 0.0));
  return outside + std::min(std::max(aside, above), 0.0) - rounding;
}

double shaft_distance(const Shaft& shaft, const Eigen::Vector3d& position) {
  const double aside = (position - shaft.bottom).head<2>().norm() - shaft.radius_m;
  const double below = shaft.bottom.z() - position.z();
  return smooth_max(aside, std::max(below, position.z() - shaft.top_z_m), 0.3);
}

}  // namespace

RockField::RockField(const Settings& settings, std::vector<Passage> passages,
                     std::vector<Shaft> shafts)
    : settings_(settings), passages_(std::move(passages)), shafts_(std::move(shafts)) {
  for (std::uint32_t i = 0; i < passages_.size(); ++i) index_passage(i);
}

void RockField::index_passage(std::uint32_t passage) {
  const Eigen::AlignedBox3d extent = box_of(passages_[passage]);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kReach_m);
  const Eigen::Vector3i low = cell_of(extent.min() - reach);
  const Eigen::Vector3i high = cell_of(extent.max() + reach);
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) near_[key_of({x, y, z})].push_back(passage);
}

// Of the air without noise.
Eigen::AlignedBox3d RockField::box_of(const Passage& passage) const {
  Eigen::AlignedBox3d extent;
  for (const Passage::End& end : {passage.from, passage.to}) {
    const Eigen::Vector3d aside(end.half_width_m, end.half_width_m, 0.0);
    extent.extend(end.floor - aside);
    extent.extend(end.floor + aside + Eigen::Vector3d(0.0, 0.0, end.height_m));
  }
  return extent;
}

std::vector<Eigen::AlignedBox3d> RockField::boxes() const {
  const Eigen::Vector3d spare = Eigen::Vector3d::Constant(
      2.0 * settings_.wall_noise_m + settings_.merge_m + 4.0 * settings_.floor_noise_m + 0.5);
  std::vector<Eigen::AlignedBox3d> all;
  for (const Passage& passage : passages_) {
    const Eigen::AlignedBox3d extent = box_of(passage);
    all.emplace_back(extent.min() - spare, extent.max() + spare);
  }
  for (const Shaft& shaft : shafts_) {
    const Eigen::Vector3d top(shaft.bottom.x(), shaft.bottom.y(), shaft.top_z_m);
    const Eigen::Vector3d aside(shaft.radius_m, shaft.radius_m, 0.0);
    all.emplace_back(shaft.bottom - aside - spare, top + aside + spare);
  }
  return all;
}

RockField::Smooth RockField::smooth_at(const Eigen::Vector3d& position) const {
  Smooth smooth{kReach_m, position.z() + kReach_m, 1.0, kReach_m};
  for (const Shaft& shaft : shafts_)
    smooth.others = std::min(smooth.others, shaft_distance(shaft, position));
  const auto found = near_.find(key_of(cell_of(position)));
  if (found == near_.end()) return smooth;
  double floor_sum = 0.0;
  double weight_sum = 0.0;
  for (const std::uint32_t i : found->second) {
    const Slice slice = slice_at(passages_[i], position);
    const double walls =
        settings_.section == Section::kOval ? oval_distance(slice) : drift_distance(slice);
    if (passages_[i].is_flight) {
      smooth.others = std::min(smooth.others, std::max({walls, -slice.above_m, slice.beyond_m}));
      continue;
    }
    smooth.walls = smooth_min(smooth.walls, walls, settings_.merge_m);
    smooth.from_middle = std::min(smooth.from_middle, slice.aside_m / slice.half_width_m);
    // Inverse distance weights: on a floor line the floor is that line. They end within the reach
    // of the index, or the floor would jump from one of its cells to the next.
    const double away2 = slice.aside_m * slice.aside_m + slice.above_m * slice.above_m;
    const double reach = std::max(slice.half_width_m, slice.height_m) + kReach_m;
    const double fading = std::max(0.0, 1.0 - away2 / (reach * reach));
    // What is well above a point is the floor of another storey.
    const double storey = std::clamp((slice.above_m + 2.0) / 1.5, 0.0, 1.0);
    const double weight = storey * fading * fading / ((away2 + 0.02) * (away2 + 0.02));
    floor_sum += weight * slice.floor_z;
    weight_sum += weight;
  }
  if (weight_sum > 0.0) smooth.floor_z = floor_sum / weight_sum;
  return smooth;
}

double RockField::value_of(const Smooth& smooth, const Eigen::Vector3d& position) const {
  // Far from the surface noise cannot change the sign.
  constexpr double kNear_m = 0.4;
  const double merge = std::min(0.3, settings_.merge_m);
  double walls = smooth.walls;
  double floor = smooth.floor_z - position.z();
  const double wall_height = 1.5 * settings_.wall_noise_m;
  if (std::abs(walls) < wall_height + kNear_m && floor < wall_height + kNear_m)
    walls += settings_.wall_noise_m *
             fractal_noise(position / settings_.wall_wavelength_m, 3, settings_.seed);
  const double floor_height = settings_.floor_noise_m * (1.0 + smooth.from_middle);
  if (std::abs(floor) < 1.5 * floor_height + kNear_m && walls < kNear_m + merge)
    floor += floor_height * fractal_noise(position / 1.1, 2, settings_.seed + 1);
  double others = smooth.others;
  if (std::abs(others) < wall_height + kNear_m)
    others += 0.5 * settings_.wall_noise_m * fractal_noise(position, 2, settings_.seed + 2);
  return smooth_min(smooth_max(walls, floor, merge), others, 0.3);
}

double RockField::value(const Eigen::Vector3d& position) const {
  return value_of(smooth_at(position), position);
}

bool RockField::may_cross(const Eigen::Vector3d& centre, double radius_m) const {
  const Smooth smooth = smooth_at(centre);
  const double rock = std::max(smooth.walls, smooth.floor_z - centre.z());
  const double distance = std::min(rock, smooth.others);
  // Slopes make the field steeper than a distance; noise moves the surface.
  const double bound = 1.3 * radius_m + 1.2 * settings_.wall_noise_m;
  return std::abs(distance) < bound;
}

double RockField::ground_z(const Eigen::Vector3d& position) const {
  Eigen::Vector3d probe = position;
  constexpr double kStep_m = 0.05;
  constexpr double kDeepest_m = 30.0;
  while (value(probe) < 0.0 && position.z() - probe.z() < kDeepest_m) probe.z() -= kStep_m;
  return probe.z() + kStep_m / 2.0;
}

TriangleMesh mesh_of(const RockField& field, double cell_m) {
  TriangleMesh mesh = surface_nets(field, field.boxes(), cell_m);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3f normal = (mesh.vertices[b] - mesh.vertices[a])
                                       .cross(mesh.vertices[c] - mesh.vertices[a])
                                       .normalized();
    if (normal.z() > static_cast<float>(kFloorNormal)) mesh.surfaces[i] = Surface::kFloor;
  }
  return mesh;
}

}  // namespace warren::world
