// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace warren::world {

// Do a triangle and a box of the same half size in all directions touch? Exact up to rounding, by
// the separating axes of Akenine-Moller (2001): three faces, one triangle, nine cross products.
bool triangle_touches_box(const std::array<Eigen::Vector3d, 3>& triangle,
                          const Eigen::Vector3d& box_centre, double half_m);

}  // namespace warren::world
