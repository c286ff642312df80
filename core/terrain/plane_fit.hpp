// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/terrain/neighbourhood.hpp"

namespace warren {

// Per point, the plane through its neighbourhood; not set where there is none. Each array has
// kVectorPadding more values.
struct PlaneFits {
  std::vector<float> normal_x;  // unit, of either sign
  std::vector<float> normal_y;
  std::vector<float> normal_z;
  std::vector<float> curvature;  // l0 / (l0 + l1 + l2), 0..1/3
  // Variances along the axes of the neighbourhood, m^2, ascending.
  std::vector<float> l0;
  std::vector<float> l1;
  std::vector<float> l2;

  void resize(std::size_t points);
};

// Fits a plane to every neighbourhood of k points: eigenvalues in closed form, in double, around
// the neighbourhood's own centre. Every CPU gives the same bits.
void fit_planes(const Neighbourhoods& neighbourhoods, std::uint32_t k, PlaneFits& fits);

}  // namespace warren
