// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/exchange/atomic_file.hpp"
#include "tools/world/simulation.hpp"

namespace warren::world {

struct TruthOptions {
  double cloud_spacing_m = 0.1;        // between samples of the surface
  double seen_range_m = 20.0;          // to which robots see them
  double drivability_spacing_m = 0.5;  // of the grid of ground points; 0: none
};

// Writes what a recording can be judged by into a folder, which it makes:
//   mesh.ply                 the world
//   cloud.ply                x y z surface seen: samples of its surface, the kind as in
//   surfaces.json,
//                            1 if a robot's sensor could see it
//   surfaces.json            by kind: its number, how many samples, how many of them seen
//   stairs.json              every flight, its steps and the edges of them
//   drivability.csv          ground points; per vehicle the shares of headings to stand and to move
//   trajectory_NAME.txt      per robot, TUM format: T_world_base every 0.1 s
//   believed_NAME.txt        the same as it believes: T_map_base
//   frames.json              per robot T_world_map, the frame that it believes in
WriteResult write_truth(const std::filesystem::path& folder, const Simulation& simulation,
                        const TruthOptions& options = {});

}  // namespace warren::world
