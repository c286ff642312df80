// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "tools/world/passage_graph.hpp"
#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

// A straight flight as an object: the truth that stair detectors are judged on. It has no direction
// of its own; up and down are the same flight.
struct Stairway {
  Eigen::Vector3d foot;     // middle of the lowest riser's lower edge
  double yaw_rad = 0.0;     // of the ascent, from x towards y
  std::uint32_t steps = 0;  // risers
  double rise_m = 0.0;
  double run_m = 0.0;
  double width_m = 0.0;

  struct Edge {
    Eigen::Vector3d left;  // seen when ascending
    Eigen::Vector3d right;
  };
  // A point on the flight: along the ascent, to the left of its middle, above the foot.
  Eigen::Vector3d at(double along_m, double left_m, double up_m) const;
  std::vector<Edge> edges() const;  // the nosing of every step, from the foot up
  Eigen::Vector3d top() const;      // middle of the highest edge
};

struct World {
  std::string name;
  std::uint64_t seed = 0;
  TriangleMesh mesh;
  std::vector<Stairway> stairways;
  PassageGraph passages;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  // where robots come in, on the floor
  double start_yaw_rad = 0.0;
};

// Names of the presets, for help texts: cave, tunnel, urban, mine, room, and edgar, which needs the
// recorded data (WARREN_DATA) and heeds neither seed nor length.
std::vector<std::string> preset_names();

struct WorldSpec {
  std::string preset = "cave";
  std::uint64_t seed = 1;
  double length_m = 0.0;  // of all passages, about; 0: the preset's own (100-400 m)
};
// The same spec gives the same bytes. An error names the presets.
tl::expected<World, std::string> make_world(const WorldSpec& spec);

}  // namespace warren::world
