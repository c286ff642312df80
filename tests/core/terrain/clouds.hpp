// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <hwy/targets.h>
#include <rapidcheck.h>

#include "core/terrain/cloud_reduction.hpp"

namespace warren::test {

// Points of an x-y grid, lifted and turned about y, so that it rises along x by `slope_rad`.
inline std::vector<Point3f> ramp(float slope_rad, int per_side = 41, float spacing_m = 0.05F) {
  std::vector<Point3f> points;
  for (int i = 0; i < per_side; ++i) {
    for (int j = 0; j < per_side; ++j) {
      const float along = static_cast<float>(i) * spacing_m;
      points.push_back({along * std::cos(slope_rad), static_cast<float>(j) * spacing_m,
                        along * std::sin(slope_rad)});
    }
  }
  return points;
}

// A cloud of up to `most` points: scattered, clustered far apart, on one line or on a lattice
// (where many are equally far), of any size from centimetres to kilometres.
inline std::vector<Point3f> arbitrary_cloud(std::size_t most) {
  const auto count = *rc::gen::inRange<std::size_t>(0, most);
  const int kind = *rc::gen::inRange(0, 4);
  const auto size_mm = *rc::gen::element(100, 1000, 10000, 1000000);
  const auto coordinate = rc::gen::inRange(-size_mm, size_mm + 1);
  std::vector<Point3f> points;
  Point3f cluster;
  for (std::size_t i = 0; i < count; ++i) {
    const auto metres = [&] { return 1e-3F * static_cast<float>(*coordinate); };
    if (kind == 0) points.push_back({metres(), metres(), metres()});
    if (kind == 1) {
      if (i % 20 == 0) cluster = {10.0F * metres(), metres(), metres()};
      const auto near = [] { return 1e-3F * static_cast<float>(*rc::gen::inRange(0, 300)); };
      points.push_back({cluster.x + near(), cluster.y + near(), cluster.z + near()});
    }
    if (kind == 2) points.push_back({metres(), 0.0F, 0.0F});
    if (kind == 3) {
      const auto step = [] { return 0.125F * static_cast<float>(*rc::gen::inRange(0, 8)); };
      points.push_back({step(), step(), step()});
    }
  }
  return points;
}

// Calls check() with every instruction set that this CPU has, and then leaves it the choice again.
template <typename Check>
void on_every_target(Check&& check) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace warren::test
