// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/layer/code_cells.hpp"
#include "daemon/control/request.hpp"

namespace warren {

// The cells that a box touches, x fastest.
struct CellsAnswer {
  static constexpr std::uint64_t kCellsMax = 4096;

  double resolution_m = 0.0;
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  // of key (0, 0, 0)
  int level = 0;
  std::vector<CodeNode> cells;

  double cell_m() const { return resolution_m * (1 << level); }
  Eigen::Vector3d low_map(const CodeNode& cell) const {
    return origin_map + Eigen::Vector3d(cell.low.x, cell.low.y, cell.low.z) * resolution_m;
  }
};

// The cells of a question about a map of this resolution whose key (0, 0, 0) lies there in the map
// frame; or why there are none, in words for the client.
tl::expected<CellGrid, std::string> grid_of(const CellsQuestion& question, double resolution_m,
                                            const Eigen::Vector3d& origin_map);

}  // namespace warren
