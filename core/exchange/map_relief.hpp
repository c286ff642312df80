// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/exchange/exported_map.hpp"

namespace warren {

// Where the ground of a map is, so that a picture can leave out the ceiling above it. Columns of
// voxels are taken together to at most kMaxCells per axis; memory does not grow with the map.
class MapRelief {
 public:
  static constexpr std::int32_t kMaxCells = 1024;
  static constexpr double kCutAboveFloor_m = 2.0;

  // Precondition: the map holds known voxels within `bounds`.
  MapRelief(const ExportedMap& map, const KeyBox& bounds);

  // False for what lies too far above the ground around it.
  bool is_shown(const VoxelKey& key) const;
  // Calls visit(key of the column's centre at the ground, edge in voxels) for every cell with free
  // space above its ground.
  void for_each_free_cell(
      const std::function<void(const VoxelKey&, std::int32_t edge)>& visit) const;

  // Box of nearly all that is shown (a little far out does not count); nothing if no voxel is
  // occupied.
  const std::optional<KeyBox>& extent() const { return extent_; }

 private:
  struct Cell {
    std::int32_t lowest = kNothing;  // key z of the lowest occupied voxel
    std::int32_t lowest_free = kNothing;
    std::int32_t floor = kNothing;  // of the ground around it
    bool free = false;
  };
  static constexpr std::int32_t kNothing = kKeyMax + 1;

  std::size_t cell_index(std::int32_t key_x, std::int32_t key_y) const;
  void find_lowest(const ExportedMap& map);
  bool shows_ground(const Cell& cell) const;
  // The ground under every tile of about a metre; kNothing where none was seen.
  std::vector<std::int32_t> floors_of_tiles() const;
  std::vector<std::int32_t> smoothed(const std::vector<std::int32_t>& floors) const;
  // Where no ground was seen it goes on like the nearest that was.
  void spread(std::vector<std::int32_t>& floors) const;
  void find_floors();
  void measure_shown(const ExportedMap& map);

  VoxelKey low_;
  std::int32_t edge_;  // of a cell, in voxels
  std::int32_t columns_;
  std::int32_t rows_;
  std::int32_t tile_;  // edge in cells
  std::int32_t tile_columns_;
  std::int32_t tile_rows_;
  std::int32_t cut_voxels_;
  std::vector<Cell> cells_;
  std::optional<KeyBox> extent_;
};

}  // namespace warren
