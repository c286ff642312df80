// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/exchange/map_snapshot.hpp"
#include "core/exchange/merged_snapshot.hpp"

namespace warren {

// Which frame a file's coordinates are in: keys of the layer plus `shift` voxels.
struct FileFrame {
  LayerOrigin shift;
  std::string note;  // empty in the map frame
};

// What decides about frames.
struct MapPlace {
  LayerOrigin origin;
  std::optional<KeyBox> bounds;  // of the known voxels
  double resolution_m = 0.0;
};
MapPlace place_of(const MapSnapshot& map);
MapPlace place_of(const MergedSnapshot& map);

// The map frame if all known keys, moved there, stay in OctoMap's 16-bit key space; else the layer
// frame, with a note.
FileFrame frame_for_tree(const MapPlace& place);

// The map frame if float32 holds voxel centres there to 1 % of the resolution; else the layer
// frame, with a note.
FileFrame frame_for_cloud(const MapPlace& place);

}  // namespace warren
