// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/layer/replica.hpp"

namespace warren {

// How a layer has to lie apart from where its origin's word puts it, so that its obstacles fall on
// another's: turned about the vertical through its origin, then shifted.
struct RegistrationResult {
  static constexpr double kTrustedFit = 0.7;
  static constexpr std::uint64_t kTrustedVoxels = 500;

  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  // fleet frame
  double yaw_rad = 0.0;
  std::uint64_t voxels = 0;  // occupied ones of the layer, so placed, with one of the other's near
  double fit_before = 0.0;   // share of those near, as the layer lies now, that fall on the other's
  double fit = 0.0;          // the same of `voxels`
  double rms_m = 0.0;        // distance of those that fall on the other's

  bool is_trusted() const {
    return voxels >= kTrustedVoxels && fit >= kTrustedFit && fit >= fit_before;
  }
};

// Seeks near where both layers lie now: up to some 2 m and 30 degrees off, turned about the
// vertical alone. PCL's NDT from several headings, then GICP from the best. Seconds of one core;
// the error is a sentence: there is too little that may overlap.
tl::expected<RegistrationResult, std::string> register_layers(const Replica& layer,
                                                              const Replica& against);

}  // namespace warren
