// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/plane_fit.hpp"

#include <cassert>

#include "core/terrain/plane_kernel.hpp"

namespace warren {

void PlaneFits::resize(std::size_t points) {
  for (auto* row : {&normal_x, &normal_y, &normal_z, &curvature, &l0, &l1, &l2}) {
    row->resize(points + kVectorPadding);
  }
}

void fit_planes(const Neighbourhoods& neighbourhoods, std::uint32_t k, PlaneFits& fits) {
  assert(k > 0);
  const std::size_t points = neighbourhoods.states.size();
  fits.resize(points);
  MomentRows moments{};
  for (std::size_t i = 0; i < moments.size(); ++i) moments[i] = neighbourhoods.moments[i].data();
  const PlaneRows planes{fits.normal_x.data(),  fits.normal_y.data(), fits.normal_z.data(),
                         fits.curvature.data(), fits.l0.data(),       fits.l1.data(),
                         fits.l2.data()};
  fit_plane_rows(moments, 1.0 / k, points, planes);
}

}  // namespace warren
