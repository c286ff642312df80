// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "core/exchange/map_picture.hpp"
#include "core/exchange/map_snapshot.hpp"
#include "core/exchange/merged_snapshot.hpp"
#include "core/layer/replica.hpp"

namespace warren {

struct SaveReport {
  std::string format;        // the ending without its dot: "bt", "ot", "ply", "pcd", "png"
  std::uint64_t bytes = 0;   // of the file
  std::uint64_t voxels = 0;  // in the file; of a picture: in the map
  std::string note;          // what a reader of the file should know, e.g. its frame; may be empty
};

// Writes the map by the file's ending: .bt .ot OctoMap trees, .ply .pcd centres of the occupied
// voxels (float32 x y z, probability p and cost, NaN without data), .png a picture for people.
// Trees and clouds are in the map frame unless that cannot hold them exactly; then in the layer
// frame, and the note says where that lies. The file is replaced whole and on disk, or, on an
// error, left as it was.
tl::expected<SaveReport, std::string> save_map(const MapSnapshot& map,
                                               const std::filesystem::path& file,
                                               PictureColours colours = PictureColours::kHeight);

// Likewise the merge-map. Clouds also tell whose word each voxel is: `source`, 0 for this robot and
// from 1 on for the layers of others, which comments in the header name with their nodes, and `rgb`
// by source.
tl::expected<SaveReport, std::string> save_merged_map(
    const MergedSnapshot& map, const std::filesystem::path& file,
    PictureColours colours = PictureColours::kSource);

// Likewise a layer as .bt .ot .ply or .pcd, in the layer frame.
tl::expected<SaveReport, std::string> export_layer(const Replica& layer,
                                                   const std::filesystem::path& file);

}  // namespace warren
