// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/terrain/tile_grid.hpp"
#include "core/voxel/point.hpp"

namespace warren {

// More points than any lidar gives in one scan; the rest of a hostile scan is left out, counted.
inline constexpr std::size_t kMaxReducedPoints = std::size_t{1} << 24;

// A cloud with one point per occupied cell of a cubic grid, laid out for neighbour search: points
// tile by tile in Morton order. The order depends on where points are, not on how they came.
struct ReducedCloud {
  std::vector<float> x;  // metres
  std::vector<float> y;
  std::vector<float> z;
  std::vector<std::uint32_t> weights;  // how many points each one stands for
  TileLevel tiles;

  std::size_t size() const { return x.size(); }
  Point3f point(std::size_t index) const { return {x[index], y[index], z[index]}; }
};

// What of a cloud is reduced.
struct ReductionSphere {
  Point3f centre;
  float radius_m = std::numeric_limits<float>::infinity();
};

struct ReductionReport {
  std::uint64_t not_finite = 0;
  std::uint64_t outside = 0;     // more than kCellLimit cells away
  std::uint64_t too_far = 0;     // outside the sphere
  std::uint64_t over_limit = 0;  // beyond kMaxReducedPoints
};

// Centroid per cell: the cells are those of pcl::VoxelGrid, the centroids too, up to its float
// rounding. Ours are summed exactly, so the order of points does not change a bit. Reuses buffers.
class CloudReducer {
 public:
  explicit CloudReducer(float cell_m);

  // Lives until the next call.
  const ReducedCloud& reduce(std::span<const Point3f> points, const ReductionSphere& within = {});
  const ReductionReport& report() const { return report_; }

 private:
  // A number of up to 24 bits with the cell within a tile below it.
  using WithCell = std::uint32_t;
  static constexpr WithCell kLeftOut = 0xFFFFFFFFU;

  void place_points(std::span<const Point3f> points, const ReductionSphere& within);
  WithCell place(float x, float y, float z);
  WithCell leave_out(const Point3f& point);
  void order_tiles();
  void group_points_by_tile();
  void add_tile(const Tile& tile, std::span<const Point3f> points,
                std::span<const WithCell> in_tile);

  float cell_m_;
  float per_metre_;
  ReductionReport report_;
  TileTable table_;  // packed place to a number in met_tiles_
  std::uint64_t last_key_ = 0;
  std::uint32_t last_tile_ = 0;
  std::vector<Tile> met_tiles_;    // in the order of first meeting; `end` counts points
  std::vector<WithCell> placed_;   // by point: its tile, in the order of first meeting
  std::vector<WithCell> grouped_;  // indices of points, tile by tile
  struct Ranked {
    std::uint64_t morton = 0;
    std::uint32_t met = 0;
  };
  std::vector<Ranked> ranked_;
  std::vector<std::uint32_t> rank_of_met_;
  std::vector<std::uint32_t> starts_;  // by rank: where its points begin in grouped_
  std::vector<Tile> tiles_;
  ReducedCloud cloud_;
};

}  // namespace warren
