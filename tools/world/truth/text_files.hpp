// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tools/world/simulation.hpp"
#include "tools/world/truth/drivability.hpp"
#include "tools/world/truth/surface_cloud.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

// The texts of write_truth(): the same input gives the same bytes.
std::string stairs_json(std::span<const Stairway> stairways);

// Samples and how many of them, in the same order, were seen.
std::string surfaces_json(std::span<const SurfaceSample> all, std::span<const SurfaceSample> seen);

std::string drivability_csv(std::span<const GroundTruth> ground, std::span<const Vehicle> vehicles);

enum class Belief : std::uint8_t { kTruth, kOdometry };
std::string trajectory_tum(const Simulation& simulation, std::size_t robot, Belief belief);

std::string frames_json(const Simulation& simulation);

}  // namespace warren::world
