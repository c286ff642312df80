// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "tools/world/caster.hpp"
#include "tools/world/vehicle.hpp"

namespace warren::world {

// Does the ground reach the belly between the axles? Rays along and across the plane of the belly.
bool belly_touches(const Caster& caster, const Vehicle& vehicle,
                   const Eigen::Isometry3d& T_world_base);

// Is there anything in the box of the body, from the belly up? Rays around and through it in layers
// 0.15 m apart, and upright ones: what is thinner than the gaps between the rays may pass.
bool body_touches(const Caster& caster, const Vehicle& vehicle,
                  const Eigen::Isometry3d& T_world_base);

}  // namespace warren::world
