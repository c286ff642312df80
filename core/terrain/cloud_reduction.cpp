// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/cloud_reduction.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace warren {
namespace {

constexpr std::uint32_t kCellsPerTile = kTileCells * kTileCells * kTileCells;
static_assert(kCellsPerTile <= 64, "one mask names the occupied cells");
static_assert(kMaxReducedPoints * kCellsPerTile < 0xFFFFFFFFU, "a number with its cell fits");

// Adding and taking away this rounds a small number to a multiple of 2^-30 m: sums of up to 2^22
// such offsets within a tile are exact, in whatever order.
constexpr double kRounder = 1.5 * 4194304.0;
double rounded(double offset_m) { return (offset_m + kRounder) - kRounder; }

// Whole cells from the low corner of the cell space. std::floor is a call on baseline x86-64.
std::uint32_t cell_at(float scaled) {
  const auto truncated = static_cast<std::int32_t>(scaled);
  const std::int32_t floor = truncated - (static_cast<float>(truncated) > scaled ? 1 : 0);
  return static_cast<std::uint32_t>(floor + kCellLimit);
}

double low_corner_m(std::uint32_t tile, double cell_m) {
  return (static_cast<double>(tile) * kTileCells - kCellLimit) * cell_m;
}

struct CellSum {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  std::uint32_t weight = 0;
};

}  // namespace

CloudReducer::CloudReducer(float cell_m) : cell_m_(cell_m), per_metre_(1.0F / cell_m) {
  assert(cell_m > 0.0F);
}

const ReducedCloud& CloudReducer::reduce(std::span<const Point3f> points,
                                         const ReductionSphere& within) {
  report_ = {};
  report_.over_limit = points.size() - std::min(points.size(), kMaxReducedPoints);
  points = points.first(std::min(points.size(), kMaxReducedPoints));
  place_points(points, within);
  order_tiles();
  group_points_by_tile();

  cloud_.x.clear();
  cloud_.y.clear();
  cloud_.z.clear();
  cloud_.weights.clear();
  for (std::size_t rank = 0; rank < tiles_.size(); ++rank) {
    tiles_[rank].points.first = static_cast<std::uint32_t>(cloud_.size());
    add_tile(tiles_[rank], points,
             std::span(grouped_).subspan(starts_[rank], starts_[rank + 1] - starts_[rank]));
    tiles_[rank].points.end = static_cast<std::uint32_t>(cloud_.size());
  }
  cloud_.tiles.assign(tiles_, cell_m_ * static_cast<float>(kTileCells));
  return cloud_;
}

void CloudReducer::place_points(std::span<const Point3f> points, const ReductionSphere& within) {
  table_.reset(met_tiles_.size());
  met_tiles_.clear();
  last_key_ = 0;
  placed_.clear();
  placed_.reserve(points.size());
  constexpr auto kLimit = static_cast<float>(kCellLimit);
  const float squared_radius = within.radius_m * within.radius_m;
  for (const Point3f& point : points) {
    const float x = point.x * per_metre_;
    const float y = point.y * per_metre_;
    const float z = point.z * per_metre_;
    const bool in_space = std::abs(x) < kLimit && std::abs(y) < kLimit && std::abs(z) < kLimit;
    const bool is_near = squared_distance(point, within.centre) <= squared_radius;
    placed_.push_back(in_space && is_near ? place(x, y, z) : leave_out(point));
  }
}

// Gives the tile's number with the cell.
CloudReducer::WithCell CloudReducer::place(float x, float y, float z) {
  const std::uint32_t cx = cell_at(x);
  const std::uint32_t cy = cell_at(y);
  const std::uint32_t cz = cell_at(z);
  const TilePlace at{cx / kTileCells, cy / kTileCells, cz / kTileCells};
  const std::uint32_t cell =
      cx % kTileCells + kTileCells * (cy % kTileCells + kTileCells * (cz % kTileCells));
  // A beam's neighbour often hits the same tile.
  if (const std::uint64_t key = packed(at); key != last_key_) {
    const auto fresh = static_cast<std::uint32_t>(met_tiles_.size());
    last_key_ = key;
    last_tile_ = table_.find_or_add(key, fresh);
    if (last_tile_ == fresh) met_tiles_.push_back({at, {}});
  }
  ++met_tiles_[last_tile_].points.end;
  return last_tile_ * kCellsPerTile + cell;
}

CloudReducer::WithCell CloudReducer::leave_out(const Point3f& point) {
  constexpr auto kLimit = static_cast<float>(kCellLimit);
  const auto is_inside = [&](float axis_m) { return std::abs(axis_m * per_metre_) < kLimit; };
  if (!is_finite(point)) {
    ++report_.not_finite;
  } else if (is_inside(point.x) && is_inside(point.y) && is_inside(point.z)) {
    ++report_.too_far;
  } else {
    ++report_.outside;
  }
  return kLeftOut;
}

void CloudReducer::order_tiles() {
  ranked_.clear();
  for (std::size_t met = 0; met < met_tiles_.size(); ++met) {
    ranked_.push_back({morton_of(met_tiles_[met].place), static_cast<std::uint32_t>(met)});
  }
  std::sort(ranked_.begin(), ranked_.end(),
            [](const Ranked& a, const Ranked& b) { return a.morton < b.morton; });
  rank_of_met_.resize(ranked_.size());
  tiles_.clear();
  starts_.assign(1, 0);
  for (const Ranked& ranked : ranked_) {
    const Tile& met = met_tiles_[ranked.met];
    rank_of_met_[ranked.met] = static_cast<std::uint32_t>(tiles_.size());
    starts_.push_back(starts_.back() + met.points.end);
    tiles_.push_back({met.place, {}});
  }
}

void CloudReducer::group_points_by_tile() {
  // From here on met_tiles_[i].points.first is where its next point goes.
  for (std::size_t met = 0; met < met_tiles_.size(); ++met) {
    met_tiles_[met].points.first = starts_[rank_of_met_[met]];
  }
  grouped_.resize(starts_.back());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i] == kLeftOut) continue;
    const std::uint32_t place = met_tiles_[placed_[i] / kCellsPerTile].points.first++;
    grouped_[place] = static_cast<WithCell>(i) * kCellsPerTile + placed_[i] % kCellsPerTile;
  }
}

void CloudReducer::add_tile(const Tile& tile, std::span<const Point3f> points,
                            std::span<const WithCell> in_tile) {
  std::array<CellSum, kCellsPerTile> sums;  // only what the mask names is set
  std::uint64_t occupied = 0;
  const double cell_m = cell_m_;
  const double low_x = low_corner_m(tile.place.x, cell_m);
  const double low_y = low_corner_m(tile.place.y, cell_m);
  const double low_z = low_corner_m(tile.place.z, cell_m);
  for (const WithCell grouped : in_tile) {
    const Point3f& point = points[grouped / kCellsPerTile];
    CellSum& sum = sums[grouped % kCellsPerTile];
    const std::uint64_t bit = std::uint64_t{1} << grouped % kCellsPerTile;
    if ((occupied & bit) == 0) sum = {};
    occupied |= bit;
    sum.x += rounded(point.x - low_x);
    sum.y += rounded(point.y - low_y);
    sum.z += rounded(point.z - low_z);
    ++sum.weight;
  }
  for (; occupied != 0; occupied &= occupied - 1) {
    const CellSum& sum = sums[static_cast<std::size_t>(std::countr_zero(occupied))];
    const double share = 1.0 / sum.weight;
    cloud_.x.push_back(static_cast<float>(low_x + sum.x * share));
    cloud_.y.push_back(static_cast<float>(low_y + sum.y * share));
    cloud_.z.push_back(static_cast<float>(low_z + sum.z * share));
    cloud_.weights.push_back(sum.weight);
  }
}

}  // namespace warren
