// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/labelled_run.hpp"

#include <cmath>

#include "tools/world/simulation.hpp"
#include "tools/world/truth/drivability.hpp"
#include "tools/world/truth/sight.hpp"

namespace warren {
namespace {

using Positions = std::vector<Eigen::Vector3d>;

Point3f point_of(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

world::Simulation explore(const world::World& world, const LabelledRunOptions& options) {
  world::SimulationSpec spec;
  spec.seed = options.seed;
  spec.duration_s = options.duration_s;
  spec.robots.emplace_back();
  return {world, spec};
}

Positions places_around(const world::Simulation& simulation, const LabelledRunOptions& options) {
  Eigen::AlignedBox3d region;
  for (const auto& T_world_sensor : world::viewpoints_of(simulation, 0, options.scan_period_s)) {
    region.extend(T_world_sensor.translation());
  }
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(options.max_range_m);
  region = {region.min() - reach, region.max() + reach};
  return world::ground_points(simulation.caster(), region, options.place_spacing_m);
}

std::vector<PlaceInView> places_in_view(const world::Simulation& simulation,
                                        const Eigen::Isometry3d& T_world_sensor,
                                        const Positions& positions, double max_range_m) {
  const world::Sight sight(simulation.caster(), std::span(&T_world_sensor, 1),
                           world::field_of(simulation.spec().robots[0].lidar, max_range_m));
  std::vector<PlaceInView> in_view;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!sight.sees(positions[i].cast<float>())) continue;
    in_view.push_back({i, (positions[i] - T_world_sensor.translation()).norm()});
  }
  return in_view;
}

std::vector<Point3f> points_world(const world::Sweep& sweep, double max_range_m) {
  std::vector<Point3f> points;
  points.reserve(sweep.points_sensor.size());
  for (const Point3f& p : sweep.points_sensor) {
    const Eigen::Vector3d point_sensor(p.x, p.y, p.z);
    if (!(point_sensor.norm() <= max_range_m)) continue;  // nor what did not come back
    points.push_back(point_of(sweep.T_world_sensor * point_sensor));
  }
  return points;
}

class Scanner {
 public:
  Scanner(const world::Simulation& simulation, const LabelledRunOptions& options)
      : simulation_(simulation), options_(options), random_(options.seed) {}

  // The sensor turns ten times a second as ever; what lies between the scans is left out.
  LabelledScan scan_at(double end_s, const Positions& positions) {
    const world::BodyMotion& motion = simulation_.motion(0);
    const Eigen::Isometry3d T_base_sensor = simulation_.T_base_sensor(0);
    const world::Sweep sweep = world::sweep(
        {simulation_.caster(), simulation_.obstacles(0)}, simulation_.spec().robots[0].lidar,
        [&](double time_s) { return motion.T_world_base(time_s) * T_base_sensor; }, end_s,
        world::Deskew::kYes, random_);
    return {points_world(sweep, options_.max_range_m), point_of(sweep.T_world_sensor.translation()),
            places_in_view(simulation_, sweep.T_world_sensor, positions, options_.max_range_m)};
  }

 private:
  const world::Simulation& simulation_;
  const LabelledRunOptions& options_;
  world::Random random_;
};

GroundLabel label_of(const world::Drivability& drivability) {
  constexpr double kRounding = 1e-9;
  if (drivability.move > 1.0 - kRounding) return GroundLabel::kSafe;
  return drivability.move < 0.5 - kRounding ? GroundLabel::kHazard : GroundLabel::kMixed;
}

GroundPlace label_place(const world::Caster& caster, const Eigen::Vector3d& position,
                        const std::vector<world::Vehicle>& vehicles) {
  GroundPlace place{point_of(position), {}};
  for (const world::Vehicle& vehicle : vehicles) {
    place.by_vehicle.push_back(label_of(world::drivability_at(caster, vehicle, position)));
  }
  return place;
}

// Labelling is what takes the time: only what somebody saw is labelled, and kept.
std::vector<GroundPlace> label_what_was_seen(const world::Caster& caster,
                                             const Positions& positions,
                                             const std::vector<world::Vehicle>& vehicles,
                                             std::vector<LabelledScan>& scans) {
  constexpr std::size_t kUnseen = static_cast<std::size_t>(-1);
  std::vector<std::size_t> number_of(positions.size(), kUnseen);
  std::vector<GroundPlace> places;
  for (LabelledScan& scan : scans) {
    for (PlaceInView& seen : scan.in_view) {
      std::size_t& number = number_of[seen.place];
      if (number == kUnseen) {
        number = places.size();
        places.push_back(label_place(caster, positions[seen.place], vehicles));
      }
      seen.place = number;
    }
  }
  return places;
}

}  // namespace

LabelledRun explore_and_label(const world::World& world, const LabelledRunOptions& options) {
  const world::Simulation simulation = explore(world, options);
  const Positions positions = places_around(simulation, options);
  Scanner scanner(simulation, options);
  LabelledRun run{world.name, {}, {}};
  for (int i = 1; i * options.scan_period_s <= options.duration_s; ++i) {
    run.scans.push_back(scanner.scan_at(i * options.scan_period_s, positions));
  }
  run.places = label_what_was_seen(simulation.caster(), positions, options.vehicles, run.scans);
  return run;
}

}  // namespace warren
