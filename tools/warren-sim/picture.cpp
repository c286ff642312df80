// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-sim/picture.hpp"

#include <cmath>
#include <numbers>

#include "tools/warren-sim/view.hpp"
#include "tools/world/node_grid.hpp"

namespace warren::world {
namespace {

constexpr double kCutM = 2.0;     // above the floor
constexpr double kReachM = 12.0;  // from the passages' middle lines
constexpr float kEyeHeightM = 0.7F;
constexpr double kDegree = std::numbers::pi / 180.0;

// Floors of the passages, to know how high above them something is.
class CutAway {
 public:
  explicit CutAway(const PassageGraph& passages) : passages_(passages), grid_(passages) {}

  bool operator()(const Eigen::Vector3f& position) const {
    const Eigen::Vector3d here = position.cast<double>();
    double nearest_m = kReachM;
    double floor_z = here.z();
    for (const std::uint32_t node : grid_.within(here, kReachM)) {
      const Eigen::Vector3d& floor = passages_.nodes[node].position;
      const double distance_m = (floor - here).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      floor_z = floor.z();
    }
    return here.z() > floor_z + kCutM;
  }

 private:
  const PassageGraph& passages_;
  NodeGrid grid_;
};

}  // namespace

tl::expected<void, std::string> render(const World& world, const std::filesystem::path& directory) {
  const Caster caster(world.mesh);
  const CutAway cut_away(world.passages);
  const Eigen::AlignedBox3f box = world.mesh.bounds();
  const Eigen::Vector3f eye = world.start.cast<float>() + Eigen::Vector3f(0.0F, 0.0F, kEyeHeightM);
  struct Picture {
    const char* name;
    View view;
    Style style;
  };
  const Picture pictures[] = {
      {"outside.png", parallel_view(box, 50.0 * kDegree, 35.0 * kDegree), {.backs = Backs::kSolid}},
      {"cutaway.png", parallel_view(box, 50.0 * kDegree, 50.0 * kDegree), {.is_cut = cut_away}},
      {"plan.png", parallel_view(box, 90.0 * kDegree, 90.0 * kDegree), {.is_cut = cut_away}},
      {"robot.png", eye_view(eye, world.start_yaw_rad, 0.0, 80.0 * kDegree), {}},
  };
  for (const Picture& picture : pictures) {
    auto written = write_png(draw(caster, picture.view, picture.style), directory / picture.name);
    if (!written) return written;
  }
  return {};
}

}  // namespace warren::world
