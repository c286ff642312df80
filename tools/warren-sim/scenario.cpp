// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/scenario.hpp"

#include <numbers>

#include "tools/world/mesh_file.hpp"

namespace warren::world {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
constexpr double kJumpM = 0.5;
constexpr double kJumpRad = 3.0 * kRadPerDegree;

RobotSpec make_robot(const ScenarioOptions& options, std::uint32_t number) {
  RobotSpec robot;
  robot.name = "robot-" + std::to_string(number);
  robot.vehicle = *vehicle_of(options.vehicle);
  robot.lidar = *lidar_of(options.lidar);
  robot.lidar.columns = options.columns;
  robot.lidar.rate_hz = options.rate_hz;
  robot.speed_m_s = options.speed_m_s;
  robot.sensor_tilt_rad = options.sensor_tilt_deg * kRadPerDegree;
  robot.odometry.yaw_drift_rad_m = options.yaw_drift_deg_m * kRadPerDegree;
  robot.odometry.scale = options.scale_error;
  robot.odometry.noise_m = options.pose_noise_m;
  for (const double time_s : options.jumps_s) {
    robot.odometry.jumps.push_back({time_s, Eigen::Vector3d(kJumpM, 0.0, 0.0), kJumpRad});
  }
  return robot;
}

}  // namespace

tl::expected<World, std::string> make_world(const ScenarioOptions& options) {
  auto world = make_world(options.world);
  if (!world) return world;
  for (const PlacedMesh& placed : options.placed) {
    const auto mesh = import_mesh(placed.file);
    if (!mesh) return tl::unexpected(mesh.error());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(placed.position);
    pose.rotate(Eigen::AngleAxisd(placed.yaw_rad, Eigen::Vector3d::UnitZ()));
    world->mesh.append(*mesh, pose);
  }
  return world;
}

SimulationSpec make_simulation_spec(const ScenarioOptions& options) {
  SimulationSpec spec;
  spec.seed = options.world.seed;
  spec.duration_s = options.duration_s;
  spec.stagger_s = options.stagger_s;
  spec.people = options.people;
  spec.deskew = options.skewed ? Deskew::kNo : Deskew::kYes;
  for (std::uint32_t i = 0; i < options.robots; ++i) {
    spec.robots.push_back(make_robot(options, i));
  }
  return spec;
}

}  // namespace warren::world
