// SPDX-License-Identifier: Apache-2.0
#include "tools/world/simulation.hpp"

#include <algorithm>
#include <array>

#include "tools/world/wall_following.hpp"

namespace warren::world {
namespace {

// What the seed is forked for.
enum class Purpose : std::uint64_t {
  kRoute = 1000,
  kOdometry = 2000,
  kLidar = 3000,
  kPerson = 4000
};

Random random_for(std::uint64_t seed, Purpose purpose, std::size_t index) {
  return Random(seed).fork(static_cast<std::uint64_t>(purpose) + index);
}

double start_of(const SimulationSpec& spec, std::size_t robot) {
  return spec.stagger_s * static_cast<double>(robot);
}

// Not more of a route than can be travelled: every metre costs rays.
Route shortened(const Route& route, double length_m) {
  Route kept{route.front()};
  double travelled_m = 0.0;
  for (std::size_t i = 1; i < route.size() && travelled_m < length_m; ++i) {
    travelled_m += (route[i] - route[i - 1]).norm();
    kept.push_back(route[i]);
  }
  return kept;
}

Route explore_from_start(const World& world, const Caster& caster, const Vehicle& vehicle,
                         Random random) {
  if (world.passages.nodes.empty())
    return follow_wall(caster, vehicle, world.start, world.start_yaw_rad);
  Route route{world.start};
  const Route passages = explore(world.passages, world.passages.nearest(world.start), random);
  route.insert(route.end(), passages.begin(), passages.end());
  return route;
}

// From one place to another, picked at random, for as long as needed.
Route stroll(const PassageGraph& graph, double length_m, Random random) {
  const auto count = static_cast<std::uint32_t>(graph.nodes.size());
  Route route{graph.nodes[random.below(count)].position};
  constexpr int kMostLegs = 100;
  for (int leg = 0; leg < kMostLegs && length_of(route) < length_m; ++leg) {
    const Route way =
        route_through(graph, std::array{route.back(), graph.nodes[random.below(count)].position});
    route.insert(route.end(), way.begin() + 1, way.end());
  }
  return route;
}

BodyMotion person(const World& world, const Caster& caster, double duration_s, Random random) {
  const Gait gait{.speed_m_s = 1.2, .turn_rad_s = 2.0};
  const Route route = stroll(world.passages, gait.speed_m_s * duration_s, random);
  return {caster, spot(), shortened(route, gait.speed_m_s * duration_s), gait};
}

MovingBody body_of(const BodyMotion& motion) {
  return {.foot = [&motion](double time_s) -> Eigen::Vector3d {
    return motion.T_world_base(time_s).translation();
  }};
}

}  // namespace

Simulation::Simulation(const World& world, SimulationSpec spec)
    : world_(world), spec_(std::move(spec)), caster_(world.mesh) {
  for (std::size_t robot = 0; robot < spec_.robots.size(); ++robot) add_robot(robot);
  if (!world.passages.nodes.empty())
    for (std::size_t i = 0; i < spec_.people; ++i)
      people_.push_back(
          person(world_, caster_, spec_.duration_s, random_for(spec_.seed, Purpose::kPerson, i)));
  for (std::size_t robot = 0; robot < spec_.robots.size(); ++robot) add_obstacles(robot);
}

void Simulation::add_robot(std::size_t robot) {
  const RobotSpec& own = spec_.robots[robot];
  const Gait gait{.speed_m_s = own.speed_m_s,
                  .start_s = start_of(spec_, robot),
                  .yaw_rad = world_.start_yaw_rad};
  const Route route = own.route.empty()
                          ? explore_from_start(world_, caster_, own.vehicle,
                                               random_for(spec_.seed, Purpose::kRoute, robot))
                          : own.route;
  const double most_m = own.speed_m_s * std::max(0.0, spec_.duration_s - gait.start_s);
  motions_.emplace_back(caster_, own.vehicle, shortened(route, most_m), gait);
  const Odometry::Period period{gait.start_s, std::max(gait.start_s, spec_.duration_s)};
  odometries_.emplace_back(
      [motion = motions_.back()](double time_s) { return motion.T_world_base(time_s); }, period,
      own.odometry, spec_.map_frame, random_for(spec_.seed, Purpose::kOdometry, robot));
}

void Simulation::add_obstacles(std::size_t robot) {
  MovingBodies& bodies = obstacles_.emplace_back();
  for (std::size_t other = 0; other < spec_.robots.size(); ++other) {
    if (other == robot) continue;
    MovingBody body = body_of(motions_[other]);
    body.radius_m = spec_.robots[other].vehicle.body_length_m / 2.0;
    body.height_m = spec_.robots[other].vehicle.height_m;
    body.appears_s = motions_[other].start_s();
    bodies.add(std::move(body));
  }
  for (const BodyMotion& walker : people_) bodies.add(body_of(walker));
}

Eigen::Isometry3d Simulation::T_base_sensor(std::size_t robot) const {
  return sensor_mount(spec_.robots[robot].vehicle, spec_.robots[robot].sensor_tilt_rad);
}

FrameStream::FrameStream(const Simulation& simulation, std::size_t robot)
    : simulation_(simulation),
      robot_(robot),
      random_(random_for(simulation.spec().seed, Purpose::kLidar, robot)) {}

double FrameStream::end_of_sweep_s(std::size_t number) const {
  const double rate_hz = simulation_.spec().robots[robot_].lidar.rate_hz;
  return simulation_.motion(robot_).start_s() + static_cast<double>(number + 1) / rate_hz;
}

std::size_t FrameStream::count() const {
  std::size_t sweeps = 0;
  while (end_of_sweep_s(sweeps) <= simulation_.spec().duration_s) ++sweeps;
  return sweeps;
}

std::optional<Frame> FrameStream::next() {
  const SimulationSpec& spec = simulation_.spec();
  const LidarModel& lidar = spec.robots[robot_].lidar;
  const BodyMotion& motion = simulation_.motion(robot_);
  const Odometry& odometry = simulation_.odometry(robot_);
  const double end_s = end_of_sweep_s(sweeps_);
  if (end_s > spec.duration_s) return std::nullopt;
  ++sweeps_;
  const Eigen::Isometry3d T_base_sensor = simulation_.T_base_sensor(robot_);
  Sweep turn = sweep(
      {simulation_.caster(), simulation_.obstacles(robot_)}, lidar,
      [&](double time_s) { return motion.T_world_base(time_s) * T_base_sensor; }, end_s,
      spec.deskew, random_);
  Frame frame{.time_s = end_s,
              .T_map_base = odometry.T_map_base(end_s),
              .T_world_base = motion.T_world_base(end_s),
              .T_base_sensor = T_base_sensor,
              .gravity_map = {},
              .points_sensor = std::move(turn.points_sensor)};
  if (spec.is_gravity_known) frame.gravity_map = odometry.gravity_map();
  return frame;
}

}  // namespace warren::world
