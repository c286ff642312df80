// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/voxel/key.hpp"
#include "core/voxel/point.hpp"

namespace warren {

// Why a point, or a whole scan, was not integrated. "No return" (NaN) is not an error, but counted.
enum class Rejection : std::uint8_t {
  kNoReturn,               // a NaN coordinate
  kInfinite,               // an infinite coordinate
  kZeroRange,              // the point is the sensor
  kBelowMinRange,          // would carve a ray out of the robot's own body
  kInBodyBox,              // a part of the robot
  kOutsideKeySpace,        // more than 32768 voxels from the layer's origin
  kBadDirection,           // a no-return direction that is zero or not finite
  kBadPose,                // the scan: non-finite pose, or a quaternion that is no rotation
  kOriginOutsideKeySpace,  // the scan: its sensor is outside the layer's key space
  kBadGravity,             // the scan: a gravity direction that is zero or not finite
  kNoReturnIgnored,        // a no-return direction, and the config says not to carve
  kFrameEpochOver,         // the scan: a later frame epoch has begun
  kTooManyFrameEpochs,     // the scan: it would open more layers than are allowed
  kSensorRemoved,          // the scan: a reload has taken its sensor out of the config
};
inline constexpr std::size_t kRejectionCount = 14;
// snake_case, as it stands in status and metrics.
const char* name_of(Rejection reason);

using RejectionCounts = std::array<std::uint64_t, kRejectionCount>;
inline std::uint64_t& count_of(RejectionCounts& counts, Rejection reason) {
  return counts[static_cast<std::size_t>(reason)];
}
inline std::uint64_t sum(const RejectionCounts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

// Rigid pose as it comes from outside: not yet trusted.
struct Pose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // metres
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  static Pose of(const Eigen::Isometry3d& isometry) {
    return {isometry.translation(), Eigen::Quaterniond(isometry.linear())};
  }
  // The isometry; nothing when a number is not finite or the quaternion's norm is off 1 by more
  // than 1 % (smaller errors are normalised away).
  std::optional<Eigen::Isometry3d> checked() const;
};

// One lidar frame. Points in the sensor frame, metres, de-skewed.
struct Scan {
  Pose T_map_base;
  Pose T_base_sensor;
  Eigen::Vector3d gravity_map{0.0, 0.0, -1.0};  // unit, downwards
  std::vector<Point3f> points_sensor;
  std::vector<Point3f> no_return_directions_sensor;  // any length but zero
};

struct BodyBox {  // in the base frame, metres
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
};

// What of a sensor's scans is used.
struct SensorFilter {
  double min_range_m = 0.0;
  std::optional<double> max_range_m;  // beyond it a ray carves up to it and marks nothing
  std::optional<BodyBox> body_box;
  bool carve_no_returns = false;  // needs max_range_m
};

// Where a layer's key (0, 0, 0) lies in its map frame, in voxels; whole blocks, so that lattices of
// all layers of one resolution coincide.
struct LayerOrigin {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;
  friend bool operator==(const LayerOrigin&, const LayerOrigin&) = default;

  // The block corner at or below a position in the map frame; nothing when that is not finite or
  // farther than 2^50 voxels.
  static std::optional<LayerOrigin> snapped(const Eigen::Vector3d& position_map,
                                            double resolution_m);
  Eigen::Vector3d position_map(double resolution_m) const {
    return Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) *
           resolution_m;
  }
};

// What the self-map integrates: rays in the layer frame.
struct LayerScan {
  Point3f origin_layer;
  std::span<const Point3f> points_layer;
  std::optional<double> max_range_m;
  std::span<const Point3f> carved_ends_layer;  // ends of rays that returned nothing
};

// Filters a scan and moves it to the layer frame. Reuses its buffers: one preparer per thread.
class ScanPreparer {
 public:
  // Nothing when the whole scan was rejected. The result points into this object and lives until
  // the next call. Every rejection is added to `rejected`.
  std::optional<LayerScan> prepare(const Scan& scan, const SensorFilter& filter,
                                   const LayerOrigin& origin, double resolution_m,
                                   RejectionCounts& rejected);

 private:
  static constexpr double kPastMaxRange = 1.01;

  void move_points(const Scan& scan, const SensorFilter& filter,
                   const Eigen::Isometry3d& T_base_sensor, const Eigen::Isometry3d& T_layer_sensor,
                   RejectionCounts& rejected);
  void carve_no_returns(const Scan& scan, const SensorFilter& filter,
                        const Eigen::Isometry3d& T_layer_sensor, RejectionCounts& rejected);

  std::vector<Point3f> points_layer_;
  std::vector<Point3f> carved_ends_layer_;
};

}  // namespace warren
