// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "tools/world/floor_graph.hpp"
#include "tools/world/mesh_file.hpp"
#include "tools/world/presets.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

std::filesystem::path mesh_path() {
  const char* const data = std::getenv("WARREN_DATA");
  const std::filesystem::path folder =
      data != nullptr ? std::filesystem::path(data) : WARREN_SOURCE_DIR "/../shared/data";
  return folder / "meshes" / "edgar_mine.dae";
}

}  // namespace

tl::expected<World, std::string> make_edgar(const WorldSpec&) {
  const std::filesystem::path file = mesh_path();
  if (!std::filesystem::exists(file))
    return tl::unexpected("the world edgar needs the recorded data: there is no " + file.string() +
                          " (set WARREN_DATA to the folder of the data)");
  // "Cube" is a box that its author forgot at the origin.
  auto mesh = import_mesh(file, {.up = MeshImport::Up::kY, .leave_out = {"Cube"}});
  if (!mesh) return tl::unexpected(mesh.error());
  World world;
  world.mesh = std::move(*mesh);
  world.passages = graph_of_floor(world.mesh);
  if (world.passages.nodes.empty())
    return tl::unexpected("there is no floor to walk on in " + file.string());
  const std::uint32_t first = world.passages.nearest(Eigen::Vector3d::Zero());
  world.start = world.passages.nodes[first].position;
  const auto near = world.passages.neighbours(true)[first];
  if (!near.empty())
    world.start_yaw_rad = heading_rad(world.start, world.passages.nodes[near[0]].position);
  return world;
}

}  // namespace warren::world
