// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/text_files.hpp"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "tools/world/truth/visible_cloud.hpp"

namespace warren::world {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json to_json(const Stairway& flight) {
  Json edges = Json::array();
  for (const Stairway::Edge& edge : flight.edges())
    edges.push_back({{"left", to_json(edge.left)}, {"right", to_json(edge.right)}});
  return {{"foot", to_json(flight.foot)}, {"top", to_json(flight.top())},
          {"yaw_rad", flight.yaw_rad},    {"steps", flight.steps},
          {"rise_m", flight.rise_m},      {"run_m", flight.run_m},
          {"width_m", flight.width_m},    {"edges", edges}};
}

template <class... Numbers>
void append(std::string& text, const char* format, Numbers... numbers) {
  char line[256];
  const int length = std::snprintf(line, sizeof(line), format, numbers...);
  text.append(line, static_cast<std::size_t>(length));
}

}  // namespace

std::string stairs_json(std::span<const Stairway> stairways) {
  Json flights = Json::array();
  for (const Stairway& flight : stairways) flights.push_back(to_json(flight));
  return Json{{"stairways", flights}}.dump(2) + "\n";
}

std::string surfaces_json(std::span<const SurfaceSample> all, std::span<const SurfaceSample> seen) {
  const auto in_all = count_by_surface(all);
  const auto in_seen = count_by_surface(seen);
  Json kinds;
  for (std::size_t kind = 0; kind < kSurfaceCount; ++kind)
    kinds[name_of(static_cast<Surface>(kind))] = {
        {"number", kind}, {"samples", in_all[kind]}, {"seen", in_seen[kind]}};
  return kinds.dump(2) + "\n";
}

std::string drivability_csv(std::span<const GroundTruth> ground,
                            std::span<const Vehicle> vehicles) {
  std::string text = "x_m,y_m,z_m";
  for (const Vehicle& vehicle : vehicles)
    text += "," + vehicle.name + "_stand," + vehicle.name + "_move";
  text += "\n";
  for (const GroundTruth& point : ground) {
    append(text, "%.3f,%.3f,%.3f", point.position.x(), point.position.y(), point.position.z());
    for (const Drivability& shares : point.by_vehicle)
      append(text, ",%.3f,%.3f", shares.stand, shares.move);
    text += "\n";
  }
  return text;
}

std::string trajectory_tum(const Simulation& simulation, std::size_t robot, Belief belief) {
  constexpr double kStepS = 0.1;
  std::string text;
  const double start_s = simulation.motion(robot).start_s();
  for (int step = 0; start_s + step * kStepS <= simulation.spec().duration_s; ++step) {
    const double time_s = start_s + step * kStepS;
    const Eigen::Isometry3d T = belief == Belief::kTruth
                                    ? simulation.motion(robot).T_world_base(time_s)
                                    : simulation.odometry(robot).T_map_base(time_s);
    const Eigen::Quaterniond q(T.linear());
    append(text, "%.3f %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n", time_s, T.translation().x(),
           T.translation().y(), T.translation().z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string frames_json(const Simulation& simulation) {
  Json robots = Json::array();
  for (std::size_t robot = 0; robot < simulation.spec().robots.size(); ++robot) {
    const Eigen::Isometry3d& T = simulation.odometry(robot).T_world_map();
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
    robots.push_back({{"name", simulation.spec().robots[robot].name}, {"T_world_map", rows}});
  }
  return Json{{"robots", robots}}.dump(2) + "\n";
}

}  // namespace warren::world
