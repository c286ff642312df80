// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "tools/world/truth/sight.hpp"
#include "tools/world/truth/surface_cloud.hpp"

namespace warren::world {

// The samples that can be seen.
std::vector<SurfaceSample> visible_part(std::span<const SurfaceSample> samples, const Sight& sight);

// How many samples lie on each kind of surface: tells whether the cables were seen.
std::array<std::size_t, kSurfaceCount> count_by_surface(std::span<const SurfaceSample> samples);

}  // namespace warren::world
