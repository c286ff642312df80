// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/map_snapshot.hpp"
#include "core/exchange/merged_snapshot.hpp"

namespace warren {

enum class PictureColours : std::uint8_t {
  kHeight,  // in the map frame, z up
  kCost,    // of the ground: black easy, white impossible, red no data
  kSource,  // whose word a voxel is
};

// Draws the map for people, 1600x900: a view from above and an oblique one, both without what lies
// 2 m or more above the local ground, with scales.
WriteResult write_map_picture(const MapSnapshot& map, const std::filesystem::path& file,
                              PictureColours colours = PictureColours::kHeight);
WriteResult write_map_picture(const MergedSnapshot& map, const std::filesystem::path& file,
                              PictureColours colours = PictureColours::kSource);

}  // namespace warren
