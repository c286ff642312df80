// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace warren {

using Cloud = std::vector<Eigen::Vector3d>;

// How well points fall on those of a fixed cloud.
struct RegistrationScore {
  std::uint64_t near = 0;     // with a fixed point within kNear_m
  std::uint64_t fitting = 0;  // with one within the tolerance
  double rms_m = 0.0;         // of those

  static constexpr double kNear_m = 1.0;
  double fit() const {
    return near == 0 ? 0.0 : static_cast<double>(fitting) / static_cast<double>(near);
  }
};

class RegistrationScorer {
 public:
  RegistrationScorer(const Cloud& fixed, double tolerance_m);
  ~RegistrationScorer();
  RegistrationScorer(const RegistrationScorer&) = delete;
  RegistrationScorer& operator=(const RegistrationScorer&) = delete;

  RegistrationScore score(const Cloud& moving, const Eigen::Isometry3d& motion) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  double tolerance_m_;
};

}  // namespace warren
