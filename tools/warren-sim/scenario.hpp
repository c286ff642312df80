// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/world/simulation.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

// A mesh file put into a world, e.g. a NIST element: its origin, turned about z.
struct PlacedMesh {
  std::string file;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

// What the command line says about where, who and how long. Units as the command line has them.
struct ScenarioOptions {
  WorldSpec world;
  std::vector<PlacedMesh> placed;
  double duration_s = 60.0;
  std::uint32_t robots = 1;
  std::uint32_t people = 0;
  std::string vehicle = "husky";
  std::string lidar = "os1-64";
  std::uint32_t columns = 1024;
  double rate_hz = 10.0;
  double speed_m_s = 1.0;
  double stagger_s = 10.0;
  double sensor_tilt_deg = 0.0;
  bool skewed = false;
  double yaw_drift_deg_m = 0.0;
  double scale_error = 0.0;
  double pose_noise_m = 0.0;
  std::vector<double> jumps_s;  // at each the map frame moves by 0.5 m and 3 degrees
};

tl::expected<World, std::string> make_world(const ScenarioOptions& options);
SimulationSpec make_simulation_spec(const ScenarioOptions& options);

}  // namespace warren::world
