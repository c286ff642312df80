// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/terrain/cloud_reduction.hpp"
#include "core/terrain/neighbour_kernel.hpp"

namespace warren {

// Copies the points of some ranges into one row per axis. Reuses its buffer.
class CandidateGatherer {
 public:
  // Lives until the next call.
  Candidates gather(const ReducedCloud& cloud, std::span<const PointRange> around) {
    std::size_t count = 0;
    for (const PointRange& range : around) count += range.size();
    const std::size_t row = count + kVectorPadding;
    if (rows_.size() < 3 * row) rows_.resize(3 * row);
    float* x = rows_.data();
    for (const PointRange& range : around) {
      const std::size_t size = range.size();
      std::copy_n(cloud.x.data() + range.first, size, x);
      std::copy_n(cloud.y.data() + range.first, size, x + row);
      std::copy_n(cloud.z.data() + range.first, size, x + 2 * row);
      x += size;
    }
    return {rows_.data(), rows_.data() + row, rows_.data() + 2 * row, count};
  }

 private:
  std::vector<float> rows_;
};

}  // namespace warren
