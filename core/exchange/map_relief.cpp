// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_relief.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace warren {
namespace {

constexpr double kTile_m = 1.0;
constexpr std::int32_t kSmoothTiles = 2;  // to each side
// Reflections lie below the ground, and shadows hide it: neither minimum nor median is the floor.
constexpr double kFloorShareInTile = 0.2;
constexpr double kFloorShareOfTiles = 0.3;
constexpr double kOutlierShare = 0.002;  // left out at each end of each axis
constexpr std::size_t kKeysPerAxis = 65536;

// The value that `share` of all others are below. Reorders them; precondition: not empty.
std::int32_t quantile(std::vector<std::int32_t>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

class KeyHistogram {
 public:
  void add(std::int32_t key) {
    ++counts_[static_cast<std::size_t>(key - kKeyMin)];
    ++total_;
  }
  std::uint64_t total() const { return total_; }
  std::int32_t key_at(double share) const {
    const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(total_));
    std::uint64_t below = 0;
    std::size_t key = 0;
    while (key + 1 < kKeysPerAxis && below + counts_[key] <= wanted) below += counts_[key++];
    return static_cast<std::int32_t>(key) + kKeyMin;
  }

 private:
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kKeysPerAxis);
  std::uint64_t total_ = 0;
};

std::size_t raster_index(std::int32_t row, std::int32_t columns, std::int32_t column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

std::int32_t cells_for(std::int32_t voxels, std::int32_t edge) { return (voxels - 1) / edge + 1; }

}  // namespace

MapRelief::MapRelief(const ExportedMap& map, const KeyBox& bounds) : low_(bounds.low) {
  const double resolution_m = map.resolution_m;
  const std::int32_t size_x = bounds.high.x - bounds.low.x + 1;
  const std::int32_t size_y = bounds.high.y - bounds.low.y + 1;
  edge_ = cells_for(std::max(size_x, size_y), kMaxCells);
  columns_ = cells_for(size_x, edge_);
  rows_ = cells_for(size_y, edge_);
  tile_ = std::max(1, static_cast<std::int32_t>(std::lround(std::min(
                          kTile_m / (resolution_m * edge_), static_cast<double>(kMaxCells)))));
  tile_columns_ = cells_for(columns_, tile_);
  tile_rows_ = cells_for(rows_, tile_);
  cut_voxels_ = static_cast<std::int32_t>(
      std::lround(std::min(kCutAboveFloor_m / resolution_m, double{kKeyMax})));
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  find_lowest(map);
  find_floors();
  measure_shown(map);
}

std::size_t MapRelief::cell_index(std::int32_t key_x, std::int32_t key_y) const {
  const std::int32_t column = (key_x - low_.x) / edge_;
  const std::int32_t row = (key_y - low_.y) / edge_;
  return raster_index(row, columns_, column);
}

void MapRelief::find_lowest(const ExportedMap& map) {
  map.for_each_known([&](const ExportedVoxel& voxel) {
    Cell& cell = cells_[cell_index(voxel.key.x, voxel.key.y)];
    std::int32_t& lowest = voxel.state == VoxelState::kOccupied ? cell.lowest : cell.lowest_free;
    lowest = std::min(lowest, voxel.key.z);
  });
}

// With much free space below it, what is occupied is a ceiling whose ground was not seen.
bool MapRelief::shows_ground(const Cell& cell) const {
  return cell.lowest != kNothing && cell.lowest <= cell.lowest_free + cut_voxels_ / 4;
}

std::vector<std::int32_t> MapRelief::floors_of_tiles() const {
  const auto tiles = static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_);
  std::vector<std::vector<std::int32_t>> lowest(tiles);
  for (std::int32_t row = 0; row < rows_; ++row) {
    for (std::int32_t column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[raster_index(row, columns_, column)];
      if (!shows_ground(cell)) continue;
      const std::int32_t tile = row / tile_ * tile_columns_ + column / tile_;
      lowest[static_cast<std::size_t>(tile)].push_back(cell.lowest);
    }
  }
  std::vector<std::int32_t> floors(tiles, kNothing);
  for (std::size_t i = 0; i < tiles; ++i) {
    if (!lowest[i].empty()) floors[i] = quantile(lowest[i], kFloorShareInTile);
  }
  return floors;
}

std::vector<std::int32_t> MapRelief::smoothed(const std::vector<std::int32_t>& floors) const {
  std::vector<std::int32_t> smooth(floors.size(), kNothing);
  std::vector<std::int32_t> around;
  for (std::int32_t row = 0; row < tile_rows_; ++row) {
    for (std::int32_t column = 0; column < tile_columns_; ++column) {
      around.clear();
      for (std::int32_t y = std::max(row - kSmoothTiles, 0);
           y <= std::min(row + kSmoothTiles, tile_rows_ - 1); ++y) {
        for (std::int32_t x = std::max(column - kSmoothTiles, 0);
             x <= std::min(column + kSmoothTiles, tile_columns_ - 1); ++x) {
          const std::int32_t floor = floors[raster_index(y, tile_columns_, x)];
          if (floor != kNothing) around.push_back(floor);
        }
      }
      if (around.empty()) continue;
      smooth[raster_index(row, tile_columns_, column)] = quantile(around, kFloorShareOfTiles);
    }
  }
  return smooth;
}

void MapRelief::spread(std::vector<std::int32_t>& floors) const {
  std::vector<std::int32_t> reached;  // tiles, nearest first
  for (std::size_t i = 0; i < floors.size(); ++i) {
    if (floors[i] != kNothing) reached.push_back(static_cast<std::int32_t>(i));
  }
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::int32_t row = reached[next] / tile_columns_;
    const std::int32_t column = reached[next] % tile_columns_;
    const std::int32_t floor = floors[static_cast<std::size_t>(reached[next])];
    for (const auto& [x, y] : {std::pair{column - 1, row}, std::pair{column + 1, row},
                               std::pair{column, row - 1}, std::pair{column, row + 1}}) {
      if (x < 0 || y < 0 || x >= tile_columns_ || y >= tile_rows_) continue;
      const std::int32_t tile = y * tile_columns_ + x;
      if (floors[static_cast<std::size_t>(tile)] != kNothing) continue;
      floors[static_cast<std::size_t>(tile)] = floor;
      reached.push_back(tile);
    }
  }
}

void MapRelief::find_floors() {
  std::vector<std::int32_t> floors = smoothed(floors_of_tiles());
  spread(floors);
  for (std::int32_t row = 0; row < rows_; ++row) {
    for (std::int32_t column = 0; column < columns_; ++column) {
      cells_[raster_index(row, columns_, column)].floor =
          floors[raster_index(row / tile_, tile_columns_, column / tile_)];
    }
  }
}

void MapRelief::measure_shown(const ExportedMap& map) {
  std::array<KeyHistogram, 3> axes;
  map.for_each_known([&](const ExportedVoxel& voxel) {
    const VoxelKey& key = voxel.key;
    if (!is_shown(key)) return;
    if (voxel.state == VoxelState::kFree) {
      Cell& cell = cells_[cell_index(key.x, key.y)];
      cell.free = cell.free || key.z > cell.floor;
    } else {
      axes[0].add(key.x);
      axes[1].add(key.y);
      axes[2].add(key.z);
    }
  });
  if (axes[0].total() == 0) return;
  for_each_free_cell([&](const VoxelKey& key, std::int32_t) {
    axes[0].add(std::min(key.x, kKeyMax));
    axes[1].add(std::min(key.y, kKeyMax));
  });
  const auto corner = [&](double share) {
    return VoxelKey{axes[0].key_at(share), axes[1].key_at(share), axes[2].key_at(share)};
  };
  extent_ = KeyBox{corner(kOutlierShare), corner(1.0 - kOutlierShare)};
}

bool MapRelief::is_shown(const VoxelKey& key) const {
  const Cell& cell = cells_[cell_index(key.x, key.y)];
  return cell.floor != kNothing && key.z <= cell.floor + cut_voxels_;
}

void MapRelief::for_each_free_cell(
    const std::function<void(const VoxelKey&, std::int32_t edge)>& visit) const {
  for (std::int32_t row = 0; row < rows_; ++row) {
    for (std::int32_t column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[raster_index(row, columns_, column)];
      if (!cell.free) continue;
      visit({low_.x + column * edge_ + edge_ / 2, low_.y + row * edge_ + edge_ / 2, cell.floor},
            edge_);
    }
  }
}

}  // namespace warren
