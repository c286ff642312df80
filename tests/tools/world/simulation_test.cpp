// SPDX-License-Identifier: Apache-2.0
#include "tools/world/simulation.hpp"

#include <cstring>

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"

using namespace warren;
using namespace warren::world;

namespace {

// A hall with a cross of passages in it.
World hall() {
  World world;
  world.mesh = test::room({9.0F, 9.0F, 1.5F});
  world.start = {-6.0, 0.0, -1.5};
  const Eigen::Vector3d middle(0.0, 0.0, -1.5);
  world.passages.add_node({world.start});
  world.passages.add_node({middle});
  for (const auto& [x, y] : {std::pair{6.0, 0.0}, std::pair{0.0, 6.0}, std::pair{0.0, -6.0}})
    world.passages.add_node({middle + Eigen::Vector3d(x, y, 0.0)});
  for (std::uint32_t arm : {0U, 2U, 3U, 4U}) world.passages.add_edge(1, arm);
  return world;
}

SimulationSpec two_robots() {
  SimulationSpec spec;
  spec.duration_s = 3.0;
  spec.stagger_s = 1.0;
  spec.people = 1;
  for (const char* name : {"one", "two"}) {
    RobotSpec robot;
    robot.name = name;
    robot.lidar.columns = 128;
    robot.odometry.noise_m = 0.01;
    spec.robots.push_back(robot);
  }
  return spec;
}

std::vector<Frame> frames_of(const Simulation& simulation, std::size_t robot) {
  std::vector<Frame> frames;
  FrameStream stream(simulation, robot);
  while (auto frame = stream.next()) frames.push_back(std::move(*frame));
  return frames;
}

bool same_bytes(const std::vector<Frame>& a, const std::vector<Frame>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].T_map_base.matrix() != b[i].T_map_base.matrix() ||
        std::memcmp(a[i].points_sensor.data(), b[i].points_sensor.data(),
                    a[i].points_sensor.size() * sizeof(Point3f)) != 0)
      return false;
  return true;
}

}  // namespace

TEST_CASE("each robot delivers sweeps from its arrival until the end") {
  const World world = hall();
  const Simulation simulation(world, two_robots());
  const auto first = frames_of(simulation, 0);
  const auto second = frames_of(simulation, 1);
  CHECK(first.size() == 30);
  CHECK(second.size() == 20);
  CHECK(first.front().time_s == doctest::Approx(0.1));
  CHECK(second.front().time_s == doctest::Approx(1.1));
  CHECK(first.front().points_sensor.size() == 64 * 128);
  CHECK(first.front().gravity_map->isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST_CASE("the same spec gives the same bytes, in whatever order robots are computed") {
  const World world = hall();
  const Simulation simulation(world, two_robots());
  const Simulation again(world, two_robots());
  const auto second_alone = frames_of(again, 1);
  CHECK(same_bytes(frames_of(simulation, 0), frames_of(again, 0)));
  CHECK(same_bytes(frames_of(simulation, 1), second_alone));
  SimulationSpec other = two_robots();
  other.seed = 2;
  const Simulation different(world, other);
  CHECK_FALSE(same_bytes(frames_of(simulation, 0), frames_of(different, 0)));
}

TEST_CASE("points lie on the hall's walls, or on who is in the way") {
  const World world = hall();
  const Simulation simulation(world, two_robots());
  std::size_t on_others = 0;
  for (const Frame& frame : frames_of(simulation, 1)) {
    const Eigen::Isometry3d T_world_sensor = frame.T_world_base * frame.T_base_sensor;
    for (const Point3f& p : frame.points_sensor) {
      if (!is_finite(p)) continue;
      const Eigen::Vector3d point = T_world_sensor * Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
      const double to_wall_m =
          (Eigen::Array3d(9.0, 9.0, 1.5) - point.array().abs()).abs().minCoeff();
      if (to_wall_m < 0.06) continue;
      ++on_others;
      double nearest_m = 100.0;
      for (const Cylinder& body : simulation.obstacles(1).at(frame.time_s))
        nearest_m = std::min(nearest_m, (point - body.foot).head<2>().norm() - body.radius_m);
      CHECK(nearest_m < 0.2);
    }
  }
  CHECK(on_others > 20);
}

TEST_CASE("a world without passages is explored along its walls") {
  World world = hall();
  world.passages = {};
  SimulationSpec spec = two_robots();
  spec.duration_s = 40.0;
  const Simulation simulation(world, spec);
  CHECK((simulation.motion(0).T_world_base(40.0).translation() - world.start).norm() > 5.0);
}
