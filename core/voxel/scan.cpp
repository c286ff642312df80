// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/scan.hpp"

#include <cassert>
#include <cmath>

namespace warren {
namespace {

constexpr double kQuaternionTolerance = 0.01;
// Keys count in 32 bits, origins in 64: positions up to here stay exact (2^50 voxels).
constexpr double kOriginLimitVoxels = 1125899906842624.0;

bool in_box(const Eigen::Vector3d& point, const BodyBox& box) {
  return (point.array() >= box.low.array()).all() && (point.array() <= box.high.array()).all();
}

Point3f to_point(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
Eigen::Vector3d to_vector(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

// Why a point in the sensor frame is not used; nothing if it is.
std::optional<Rejection> reason_to_reject(const Point3f& point, const SensorFilter& filter,
                                          const Eigen::Isometry3d& T_base_sensor) {
  if (std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z)) {
    return Rejection::kNoReturn;
  }
  if (!is_finite(point)) return Rejection::kInfinite;
  const Eigen::Vector3d point_sensor = to_vector(point);
  const double range_m = point_sensor.norm();
  if (range_m == 0.0) return Rejection::kZeroRange;
  if (range_m < filter.min_range_m) return Rejection::kBelowMinRange;
  if (filter.body_box && in_box(T_base_sensor * point_sensor, *filter.body_box)) {
    return Rejection::kInBodyBox;
  }
  return std::nullopt;
}

std::int64_t snap(double coordinate_m, double resolution_m) {
  const double block = std::floor(coordinate_m / (resolution_m * kBlockEdge));
  return static_cast<std::int64_t>(block) * kBlockEdge;
}

}  // namespace

const char* name_of(Rejection reason) {
  switch (reason) {
    case Rejection::kNoReturn:
      return "no_return";
    case Rejection::kInfinite:
      return "infinite";
    case Rejection::kZeroRange:
      return "zero_range";
    case Rejection::kBelowMinRange:
      return "below_min_range";
    case Rejection::kInBodyBox:
      return "in_body_box";
    case Rejection::kOutsideKeySpace:
      return "outside_key_space";
    case Rejection::kBadDirection:
      return "bad_direction";
    case Rejection::kBadPose:
      return "bad_pose";
    case Rejection::kOriginOutsideKeySpace:
      return "origin_outside_key_space";
    case Rejection::kBadGravity:
      return "bad_gravity";
    case Rejection::kNoReturnIgnored:
      return "no_return_ignored";
    case Rejection::kFrameEpochOver:
      return "frame_epoch_over";
    case Rejection::kTooManyFrameEpochs:
      return "too_many_frame_epochs";
    case Rejection::kSensorRemoved:
      return "sensor_removed";
  }
  return "unknown";
}

std::optional<Eigen::Isometry3d> Pose::checked() const {
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) return std::nullopt;
  if (std::abs(rotation.norm() - 1.0) > kQuaternionTolerance) return std::nullopt;
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = rotation.normalized().toRotationMatrix();
  isometry.translation() = translation;
  return isometry;
}

std::optional<LayerOrigin> LayerOrigin::snapped(const Eigen::Vector3d& position_map,
                                                double resolution_m) {
  assert(resolution_m > 0.0);
  const double farthest_m = position_map.cwiseAbs().maxCoeff();
  if (!(farthest_m < kOriginLimitVoxels * resolution_m)) return std::nullopt;
  return LayerOrigin{snap(position_map.x(), resolution_m), snap(position_map.y(), resolution_m),
                     snap(position_map.z(), resolution_m)};
}

std::optional<LayerScan> ScanPreparer::prepare(const Scan& scan, const SensorFilter& filter,
                                               const LayerOrigin& origin, double resolution_m,
                                               RejectionCounts& rejected) {
  const auto T_map_base = scan.T_map_base.checked();
  const auto T_base_sensor = scan.T_base_sensor.checked();
  if (!T_map_base || !T_base_sensor) {
    ++count_of(rejected, Rejection::kBadPose);
    return std::nullopt;
  }
  // In double until the layer's origin is subtracted: then float is fine, however far the robot is.
  Eigen::Isometry3d T_layer_sensor = *T_map_base * *T_base_sensor;
  T_layer_sensor.translation() -= origin.position_map(resolution_m);
  const Point3f origin_layer = to_point(T_layer_sensor.translation());
  if (!Lattice(resolution_m).key_of(origin_layer)) {
    ++count_of(rejected, Rejection::kOriginOutsideKeySpace);
    return std::nullopt;
  }
  move_points(scan, filter, *T_base_sensor, T_layer_sensor, rejected);
  carve_no_returns(scan, filter, T_layer_sensor, rejected);
  return LayerScan{origin_layer, points_layer_, filter.max_range_m, carved_ends_layer_};
}

void ScanPreparer::move_points(const Scan& scan, const SensorFilter& filter,
                               const Eigen::Isometry3d& T_base_sensor,
                               const Eigen::Isometry3d& T_layer_sensor, RejectionCounts& rejected) {
  points_layer_.clear();
  points_layer_.reserve(scan.points_sensor.size());
  for (const Point3f& point : scan.points_sensor) {
    if (const auto reason = reason_to_reject(point, filter, T_base_sensor)) {
      ++count_of(rejected, *reason);
      continue;
    }
    points_layer_.push_back(to_point(T_layer_sensor * to_vector(point)));
  }
}

void ScanPreparer::carve_no_returns(const Scan& scan, const SensorFilter& filter,
                                    const Eigen::Isometry3d& T_layer_sensor,
                                    RejectionCounts& rejected) {
  carved_ends_layer_.clear();
  if (!filter.carve_no_returns || !filter.max_range_m) {
    count_of(rejected, Rejection::kNoReturnIgnored) += scan.no_return_directions_sensor.size();
    return;
  }
  for (const Point3f& direction : scan.no_return_directions_sensor) {
    const Eigen::Vector3d along = to_vector(direction);
    const double norm = along.norm();
    if (!std::isfinite(norm) || norm == 0.0) {
      ++count_of(rejected, Rejection::kBadDirection);
      continue;
    }
    // A little past max range, so that the integration cuts it there and marks no hit.
    const Eigen::Vector3d end_sensor = along * (*filter.max_range_m * kPastMaxRange / norm);
    carved_ends_layer_.push_back(to_point(T_layer_sensor * end_sensor));
  }
}

}  // namespace warren
