// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/drivability.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/world/placement.hpp"

namespace warren::world {
namespace {

constexpr double kTrackSampleM = 0.05;

// Goes along the way of one side's wheels, from the rear wheel to where the front wheel ends.
class WheelTrack {
 public:
  WheelTrack(const WheelContacts& contacts, const Stand& stand, double left_m)
      : contacts_(contacts),
        ahead_(std::cos(stand.yaw_rad), std::sin(stand.yaw_rad)),
        origin_(stand.x_m - left_m * ahead_.y(), stand.y_m + left_m * ahead_.x()) {}

  // Nothing on it is higher or lower than a step above what lies two samples before.
  bool can_roll(double from_m, double to_m, double max_step_m) const {
    const int samples = static_cast<int>(std::ceil((to_m - from_m) / kTrackSampleM));
    std::optional<double> last_m;
    std::optional<double> before_m;
    for (int i = 0; i <= samples; ++i) {
      const Contact wheel =
          contacts_.wheel(origin_ + (from_m + (to_m - from_m) * i / samples) * ahead_);
      if (wheel.kind != Contact::Kind::kGround) return false;
      for (const auto& earlier_m : {last_m, before_m})
        if (earlier_m && std::abs(wheel.z_m - *earlier_m) > max_step_m) return false;
      before_m = last_m;
      last_m = wheel.z_m;
    }
    return true;
  }

 private:
  const WheelContacts& contacts_;
  Eigen::Vector2d ahead_;
  Eigen::Vector2d origin_;
};

Stand ahead_of(const Stand& stand, double z_m, double way_m) {
  return {stand.x_m + way_m * std::cos(stand.yaw_rad), stand.y_m + way_m * std::sin(stand.yaw_rad),
          z_m, stand.yaw_rad};
}

bool can_move(const Caster& caster, const Vehicle& vehicle, const Stand& stand, double step_m) {
  double z_m = stand.near_z_m;
  for (const double share : {0.5, 1.0}) {
    const Placement placed = place(caster, vehicle, ahead_of(stand, z_m, share * step_m));
    if (!placed.is_ok()) return false;
    z_m = placed.T_world_base->translation().z();
  }
  const WheelContacts contacts(caster, vehicle, stand);
  const double half_m = vehicle.wheelbase_m / 2.0;
  for (const double side : {-0.5, 0.5})
    if (!WheelTrack(contacts, stand, side * vehicle.track_m)
             .can_roll(-half_m, half_m + step_m, vehicle.max_step_m))
      return false;
  return true;
}

// All floors below the region's top, at one place.
void add_floors(const Caster& caster, const Eigen::Vector2d& xy, const Eigen::AlignedBox3d& region,
                std::vector<Eigen::Vector3d>& points) {
  constexpr float kPassM = 1e-3F;  // to get through the surface just found
  Eigen::Vector3f eye = Eigen::Vector3d(xy.x(), xy.y(), region.max().z()).cast<float>();
  const auto bottom = static_cast<float>(region.min().z());
  while (const auto hit = caster.down(eye, eye.z() - bottom)) {
    eye.z() -= hit->range_m;
    if (hit->normal.z() > 0.0F) points.push_back(eye.cast<double>());
    eye.z() -= kPassM;
  }
}

}  // namespace

std::vector<Eigen::Vector3d> ground_points(const Caster& caster, const Eigen::AlignedBox3d& region,
                                           double spacing_m) {
  assert(spacing_m > 0.0);
  std::vector<Eigen::Vector3d> points;
  const Eigen::Array3i low = (region.min().array() / spacing_m).ceil().cast<int>();
  const Eigen::Array3i high = (region.max().array() / spacing_m).floor().cast<int>();
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      add_floors(caster, Eigen::Vector2d(x, y) * spacing_m, region, points);
  return points;
}

Drivability drivability_at(const Caster& caster, const Vehicle& vehicle,
                           const Eigen::Vector3d& ground, const DrivabilityTest& test) {
  Drivability shares;
  for (int heading = 0; heading < test.headings; ++heading) {
    Stand stand{ground.x(), ground.y(), ground.z(),
                2.0 * std::numbers::pi * heading / test.headings};
    const Placement placed = place(caster, vehicle, stand);
    if (!placed.is_ok()) continue;
    stand.near_z_m = placed.T_world_base->translation().z();
    shares.stand += 1.0 / test.headings;
    if (can_move(caster, vehicle, stand, test.step_m)) shares.move += 1.0 / test.headings;
  }
  return shares;
}

std::vector<GroundTruth> label_ground(const Caster& caster, std::span<const Vehicle> vehicles,
                                      const Eigen::AlignedBox3d& region, double spacing_m) {
  std::vector<GroundTruth> labels;
  for (const Eigen::Vector3d& point : ground_points(caster, region, spacing_m)) {
    GroundTruth& label = labels.emplace_back(GroundTruth{point, {}});
    for (const Vehicle& vehicle : vehicles)
      label.by_vehicle.push_back(drivability_at(caster, vehicle, point));
  }
  return labels;
}

}  // namespace warren::world
