// SPDX-License-Identifier: Apache-2.0
#include "tools/world/world.hpp"

#include <array>
#include <cmath>

#include "tools/world/presets.hpp"

namespace warren::world {
namespace {

using Make = tl::expected<World, std::string> (*)(const WorldSpec&);
template <World (*make)(const WorldSpec&)>
tl::expected<World, std::string> sure(const WorldSpec& spec) {
  return make(spec);
}

struct Preset {
  const char* name;
  Make make;
};
constexpr std::array kPresets = {
    Preset{"cave", sure<make_cave>},   Preset{"tunnel", sure<make_tunnel>},
    Preset{"urban", sure<make_urban>}, Preset{"mine", sure<make_mine>},
    Preset{"room", sure<make_room>},   Preset{"edgar", make_edgar},
};

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace

Eigen::Vector3d Stairway::at(double along_m, double left_m, double up_m) const {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return foot + Eigen::Vector3d(c * along_m - s * left_m, s * along_m + c * left_m, up_m);
}

std::vector<Stairway::Edge> Stairway::edges() const {
  std::vector<Edge> all;
  for (std::uint32_t step = 0; step < steps; ++step) {
    const double along_m = step * run_m;
    const double up_m = (step + 1) * rise_m;
    all.push_back({at(along_m, width_m / 2.0, up_m), at(along_m, -width_m / 2.0, up_m)});
  }
  return all;
}

Eigen::Vector3d Stairway::top() const { return at((steps - 1.0) * run_m, 0.0, steps * rise_m); }

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  names.reserve(kPresets.size());
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

tl::expected<World, std::string> make_world(const WorldSpec& spec) {
  for (const Preset& preset : kPresets) {
    if (spec.preset != preset.name) continue;
    auto world = preset.make(spec);
    if (!world) return world;
    world->name = spec.preset;
    world->seed = spec.seed;
    return world;
  }
  return tl::unexpected("no world is called '" + spec.preset + "'; there are " +
                        joined(preset_names()));
}

}  // namespace warren::world
