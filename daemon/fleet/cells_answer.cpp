// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/cells_answer.hpp"

#include <optional>

namespace warren {
namespace {

// A corner or a voxel's edge may be a rounding off.
constexpr double kEdgeSlack = 1e-9;

std::optional<int> level_of(const CellsQuestion& question, double resolution_m) {
  if (const auto* const depth = std::get_if<std::uint32_t>(&question.size)) {
    return CodeOctree::kRootLevel - static_cast<int>(*depth);
  }
  const double cell_m = std::get<double>(question.size);
  for (int level = 0; level <= CodeOctree::kRootLevel; ++level) {
    if (resolution_m * (1 << level) * (1.0 + kEdgeSlack) >= cell_m) return level;
  }
  return std::nullopt;
}

}  // namespace

tl::expected<CellGrid, std::string> grid_of(const CellsQuestion& question, double resolution_m,
                                            const Eigen::Vector3d& origin_map) {
  const auto level = level_of(question, resolution_m);
  if (!level) return tl::unexpected(std::string("cells.cell_m is larger than the whole key space"));
  const Lattice lattice(resolution_m);
  const Eigen::Vector3d from = question.low_map - origin_map;
  const Eigen::Vector3d to = question.high_map - origin_map;
  const auto low = lattice.key_of(from.x(), from.y(), from.z());
  const auto high = lattice.key_of(to.x(), to.y(), to.z());
  if (!low || !high) return tl::unexpected(std::string("the place lies outside the map's keys"));
  const CellGrid grid({*low, *high}, *level);
  if (grid.size() > CellsAnswer::kCellsMax) {
    return tl::unexpected("the box has " + std::to_string(grid.size()) + " cells, at most " +
                          std::to_string(CellsAnswer::kCellsMax) +
                          " are told: ask for larger ones");
  }
  return grid;
}

}  // namespace warren
