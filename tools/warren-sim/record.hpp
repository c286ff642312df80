// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <tl/expected.hpp>

#include "tools/world/simulation.hpp"

namespace warren::world {

// Told after every sweep: how many are done, of how many.
using RecordProgress = std::function<void(std::size_t done, std::size_t all)>;

struct RecordSummary {
  std::size_t sweeps = 0;
  double cast_cpu_s = 0.0;  // of the sweeps alone, without the files
};

// Writes DIR/robot-N/{clouds/NNNNNN.pcd, poses.txt, true_poses.txt} for every robot: clouds in the
// sensor frame; T_map_sensor as the robot believes it, and T_world_sensor as it is (kitti). Files
// of an earlier recording in the same place are removed first. The same spec gives the same bytes.
tl::expected<RecordSummary, std::string> record(const Simulation& simulation,
                                                const std::filesystem::path& directory,
                                                const RecordProgress& progress);

}  // namespace warren::world
