// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace warren {

// Single precision is enough within a layer (2 mm at 30 km); frames stand in variables' names.
struct Point3f {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
  friend bool operator==(const Point3f&, const Point3f&) = default;
};

inline float squared_distance(const Point3f& a, const Point3f& b) {
  const float x = a.x - b.x;
  const float y = a.y - b.y;
  const float z = a.z - b.z;
  return x * x + y * y + z * z;
}

inline bool is_finite(const Point3f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace warren
