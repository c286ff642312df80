// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/exchange/atomic_file.hpp"
#include "core/exchange/exported_map.hpp"

namespace warren {

enum class OctomapFormat { kBinary, kFull };  // .bt: states only; .ot: log-odds

// Writes the layer's voxels, `shift` voxels away, as a pruned octomap::OcTree with the map's
// resolution and sensor model. Precondition: the shifted keys stay in the key space.
WriteResult write_octomap(const ExportedMap& map, const LayerOrigin& shift, OctomapFormat format,
                          const std::filesystem::path& file);

}  // namespace warren
