// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/exported_map.hpp"

namespace warren {

// Write the centres of the occupied voxels, `shift` voxels away from the layer's, as binary float32
// x y z p cost: metres, probability of occupancy, and cost of the ground, 0 easy to 1 impossible,
// NaN where there is no data. Where voxels have a source, its number follows as `source` and its
// colour, and comments in the header tell whose numbers these are.
WriteResult write_pcd(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file);
WriteResult write_ply(const ExportedMap& map, const LayerOrigin& shift,
                      const std::filesystem::path& file);

}  // namespace warren
