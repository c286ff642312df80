// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/terrain/neighbour_kernel.hpp"

namespace warren {

struct StepQuery {
  Point3f centre;
  Point3f plane;  // its product with an offset is the height across the plane, along gravity
  float radius_m = 0.0F;
};

// Room for the heights of the candidates.
class Heights {
 public:
  void reserve(std::size_t candidates) {
    if (values_.size() < candidates + 2 * kVectorPadding) {
      values_.resize(candidates + 2 * kVectorPadding);
    }
  }
  float* data() { return values_.data(); }

 private:
  std::vector<float> values_;
};

// The difference between the 95th and the 5th percentile of the heights within the radius, each
// right to 1/256 of all the difference. Every CPU gives the same bits.
float step_within(const Candidates& candidates, const StepQuery& query, Heights& heights);

}  // namespace warren
