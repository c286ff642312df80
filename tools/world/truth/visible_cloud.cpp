// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/visible_cloud.hpp"

#include <algorithm>
#include <iterator>

namespace warren::world {

std::vector<SurfaceSample> visible_part(std::span<const SurfaceSample> samples,
                                        const Sight& sight) {
  std::vector<SurfaceSample> seen;
  std::ranges::copy_if(samples, std::back_inserter(seen),
                       [&](const SurfaceSample& sample) { return sight.sees(sample.position); });
  return seen;
}

std::array<std::size_t, kSurfaceCount> count_by_surface(std::span<const SurfaceSample> samples) {
  std::array<std::size_t, kSurfaceCount> counts{};
  for (const SurfaceSample& sample : samples) ++counts.at(static_cast<std::size_t>(sample.surface));
  return counts;
}

}  // namespace warren::world
