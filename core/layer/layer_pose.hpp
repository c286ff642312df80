// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "core/voxel/scan.hpp"

namespace warren {

// A pose, by whom it was written, and how often before. Revision 0: never.
struct WrittenPose {
  std::uint32_t revision = 0;
  std::uint32_t writer = 0;
  Pose pose;
};
bool operator==(const WrittenPose& a, const WrittenPose& b);

enum class PoseResult : std::uint8_t {
  kTaken,
  kNotNewer,    // what is held is as new, or newer
  kNotWritten,  // its revision is 0
  kNotRigid,    // not finite, no rotation, or beyond LayerPose::kReach_m
};

// Where a layer lies: its origin's word (T_fleet_layer), and the operator's correction of it, a
// motion in the fleet frame. Each is replaced by a newer revision; among equal ones the higher
// writer counts, and were even that equal, the greater numbers. So what is held does not depend on
// the order of arrival, nor on how often something arrives.
class LayerPose {
 public:
  static constexpr double kReach_m = 1e8;

  PoseResult update_origin(const WrittenPose& written) { return update(origin_, written); }
  PoseResult update_correction(const WrittenPose& written) { return update(correction_, written); }

  const WrittenPose& origin() const { return origin_; }
  const WrittenPose& correction() const { return correction_; }
  // How often a pose was not rigid, or beyond kReach_m.
  std::uint64_t refused() const { return refused_; }
  // Identity before anything is written.
  Eigen::Isometry3d T_fleet_layer() const;

 private:
  PoseResult update(WrittenPose& held, const WrittenPose& written);

  WrittenPose origin_;
  WrittenPose correction_;
  std::uint64_t refused_ = 0;
};

// Refused poses leave no trace.
inline bool operator==(const LayerPose& a, const LayerPose& b) {
  return a.origin() == b.origin() && a.correction() == b.correction();
}

}  // namespace warren
