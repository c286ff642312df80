// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/write_truth.hpp"

#include <algorithm>
#include <fstream>
#include <set>

#include "core/exchange/float_rows.hpp"
#include "tools/world/mesh_file.hpp"
#include "tools/world/truth/drivability.hpp"
#include "tools/world/truth/text_files.hpp"
#include "tools/world/truth/visible_cloud.hpp"

namespace warren::world {
namespace {

WriteResult write_text(const std::filesystem::path& file, const std::string& text) {
  const auto written = write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    return out.flush() ? WriteResult{} : tl::unexpected(std::string("cannot write"));
  });
  return written ? WriteResult{} : tl::unexpected(written.error());
}

// The vehicles that take part, each once, in the robots' order.
std::vector<Vehicle> vehicles_of(const Simulation& simulation) {
  std::vector<Vehicle> vehicles;
  std::set<std::string> names;
  for (const RobotSpec& robot : simulation.spec().robots)
    if (names.insert(robot.vehicle.name).second) vehicles.push_back(robot.vehicle);
  return vehicles;
}

struct Clouds {
  std::vector<SurfaceSample> all;
  std::vector<float> rows;  // x y z surface seen
  std::vector<SurfaceSample> seen;
};

Clouds clouds_of(const Simulation& simulation, const TruthOptions& options) {
  constexpr double kViewSpacingM = 1.0;
  std::vector<Sight> sights;
  for (std::size_t robot = 0; robot < simulation.spec().robots.size(); ++robot)
    sights.emplace_back(simulation.caster(), viewpoints_of(simulation, robot, kViewSpacingM),
                        field_of(simulation.spec().robots[robot].lidar, options.seen_range_m));
  Clouds clouds;
  clouds.all = sample_surface(simulation.world().mesh, options.cloud_spacing_m,
                              Random(simulation.world().seed));
  for (const SurfaceSample& sample : clouds.all) {
    const Eigen::Vector3f& p = sample.position;
    const bool is_seen =
        std::ranges::any_of(sights, [&](const Sight& sight) { return sight.sees(p); });
    if (is_seen) clouds.seen.push_back(sample);
    clouds.rows.insert(clouds.rows.end(), {p.x(), p.y(), p.z(), static_cast<float>(sample.surface),
                                           is_seen ? 1.0F : 0.0F});
  }
  return clouds;
}

WriteResult write_clouds(const std::filesystem::path& folder, const Simulation& simulation,
                         const TruthOptions& options) {
  const Clouds clouds = clouds_of(simulation, options);
  if (auto ok = write_text(folder / "surfaces.json", surfaces_json(clouds.all, clouds.seen)); !ok)
    return ok;
  return write_rows_ply({{"x", "y", "z", "surface", "seen"}, clouds.rows}, folder / "cloud.ply");
}

WriteResult write_drivability(const std::filesystem::path& folder, const Simulation& simulation,
                              const TruthOptions& options) {
  if (options.drivability_spacing_m <= 0.0) return {};
  const std::vector<Vehicle> vehicles = vehicles_of(simulation);
  const Eigen::AlignedBox3d everywhere = simulation.world().mesh.bounds().cast<double>();
  const auto ground =
      label_ground(simulation.caster(), vehicles, everywhere, options.drivability_spacing_m);
  return write_text(folder / "drivability.csv", drivability_csv(ground, vehicles));
}

WriteResult write_trajectories(const std::filesystem::path& folder, const Simulation& simulation) {
  for (std::size_t robot = 0; robot < simulation.spec().robots.size(); ++robot)
    for (const auto& [prefix, belief] :
         {std::pair{"trajectory_", Belief::kTruth}, std::pair{"believed_", Belief::kOdometry}}) {
      const std::string name = prefix + simulation.spec().robots[robot].name + ".txt";
      auto ok = write_text(folder / name, trajectory_tum(simulation, robot, belief));
      if (!ok) return ok;
    }
  return write_text(folder / "frames.json", frames_json(simulation));
}

}  // namespace

WriteResult write_truth(const std::filesystem::path& folder, const Simulation& simulation,
                        const TruthOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return tl::unexpected(folder.string() + ": " + error.message());
  const World& world = simulation.world();
  if (auto ok = write_ply(folder / "mesh.ply", world.mesh); !ok) return ok;
  if (auto ok = write_text(folder / "stairs.json", stairs_json(world.stairways)); !ok) return ok;
  if (auto ok = write_clouds(folder, simulation, options); !ok) return ok;
  if (auto ok = write_trajectories(folder, simulation); !ok) return ok;
  return write_drivability(folder, simulation, options);
}

}  // namespace warren::world
