// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/world/body_motion.hpp"
#include "tools/world/lidar.hpp"
#include "tools/world/odometry.hpp"
#include "tools/world/world.hpp"

namespace warren::world {

struct RobotSpec {
  std::string name;
  Vehicle vehicle = husky();
  LidarModel lidar = *lidar_of("os1-64");
  double sensor_tilt_rad = 0.0;  // nose down
  double speed_m_s = 1.0;
  OdometryErrors odometry;
  Route route;  // empty: it explores
};

struct SimulationSpec {
  std::uint64_t seed = 1;
  std::vector<RobotSpec> robots;
  double duration_s = 60.0;
  double stagger_s = 10.0;  // between the robots' arrivals at the world's start
  MapFrame map_frame = MapFrame::kLevelled;
  bool is_gravity_known = true;
  Deskew deskew = Deskew::kYes;
  std::uint32_t people = 0;  // who walk about in the passages
};

struct Frame {
  double time_s = 0.0;             // end of the sweep
  Eigen::Isometry3d T_map_base;    // as the robot believes
  Eigen::Isometry3d T_world_base;  // as it is
  Eigen::Isometry3d T_base_sensor;
  std::optional<Eigen::Vector3d> gravity_map;  // unit, down
  std::vector<Point3f> points_sensor;
};

// Robots, and people in their way, that move through a world. The same spec gives the same bytes;
// every robot draws its own random numbers, so that each can be computed alone. Robots and people
// are obstacles to the sensors, not to each other. The world must outlive it.
class Simulation {
 public:
  Simulation(const World& world, SimulationSpec spec);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const SimulationSpec& spec() const { return spec_; }
  const World& world() const { return world_; }
  const Caster& caster() const { return caster_; }
  const BodyMotion& motion(std::size_t robot) const { return motions_[robot]; }
  const Odometry& odometry(std::size_t robot) const { return odometries_[robot]; }
  Eigen::Isometry3d T_base_sensor(std::size_t robot) const;
  // The others and the people, as a robot's sensor may meet them.
  const MovingBodies& obstacles(std::size_t robot) const { return obstacles_[robot]; }

 private:
  void add_robot(std::size_t robot);
  void add_obstacles(std::size_t robot);

  const World& world_;
  SimulationSpec spec_;
  Caster caster_;
  std::vector<BodyMotion> motions_;
  std::vector<BodyMotion> people_;
  std::vector<Odometry> odometries_;
  std::vector<MovingBodies> obstacles_;
};

// What one robot measures, sweep by sweep, until the simulation's duration is over. The simulation
// must outlive it.
class FrameStream {
 public:
  FrameStream(const Simulation& simulation, std::size_t robot);

  std::size_t count() const;  // of all sweeps, those taken already included
  std::optional<Frame> next();

 private:
  double end_of_sweep_s(std::size_t number) const;

  const Simulation& simulation_;
  std::size_t robot_;
  Random random_;
  std::uint32_t sweeps_ = 0;
};

}  // namespace warren::world
