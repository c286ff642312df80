// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace warren {

// Sums in the order of NearestSums, one row each.
using MomentRows = std::array<const float*, 9>;

struct PlaneRows {
  float* normal_x = nullptr;
  float* normal_y = nullptr;
  float* normal_z = nullptr;
  float* curvature = nullptr;
  float* l0 = nullptr;
  float* l1 = nullptr;
  float* l2 = nullptr;
};

// Point by point across the rows, which have kVectorPadding more values than points.
void fit_plane_rows(const MomentRows& moments, double per_point, std::size_t points,
                    const PlaneRows& planes);

}  // namespace warren
