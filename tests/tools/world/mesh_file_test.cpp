// SPDX-License-Identifier: Apache-2.0
#include "tools/world/mesh_file.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>

#include "tests/support/recorded_data.hpp"
#include "tests/tools/world/mesh_measures.hpp"
#include "tools/world/shapes.hpp"

namespace warren::world {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "warren-mesh-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("a PLY holds vertices, faces and surfaces and nothing else") {
  const TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Surface::kCable);
  REQUIRE(write_ply(folder / "one.ply", mesh).has_value());
  const std::string bytes = read(folder / "one.ply");
  const std::size_t header = bytes.find("end_header\n") + 11;
  CHECK(bytes.find("element vertex 1\n") == std::string::npos);
  CHECK(bytes.find("element vertex 3\n") != std::string::npos);
  CHECK(bytes.find("element face 1\n") != std::string::npos);
  CHECK(bytes.size() == header + 3 * 12 + 1 + 12 + 1);
  CHECK(bytes.back() == static_cast<char>(Surface::kCable));
}

TEST_CASE("a written PLY comes back through the importer as it was") {
  const TemporaryFolder folder;
  const TriangleMesh mesh =
      box({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3)}, Surface::kWall);
  REQUIRE(write_ply(folder / "box.ply", mesh).has_value());
  const auto back = import_mesh(folder / "box.ply");
  REQUIRE(back.has_value());
  CHECK(back->triangles.size() == 12);
  CHECK(back->surfaces[0] == Surface::kImported);
  CHECK(test::volume_m3(*back) == doctest::Approx(6.0));
  // y up: the box lies on its side.
  const auto turned = import_mesh(folder / "box.ply", {.up = MeshImport::Up::kY, .leave_out = {}});
  REQUIRE(turned.has_value());
  CHECK(turned->bounds().sizes() == Eigen::Vector3f(1, 3, 2));
  CHECK(test::volume_m3(*turned) == doctest::Approx(6.0));
}

TEST_CASE("what cannot be read or written is named in the error") {
  const auto missing = import_mesh("/nowhere/at_all.dae");
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().find("/nowhere/at_all.dae") != std::string::npos);
  const auto unwritable = write_ply("/nowhere/at_all.ply", {});
  REQUIRE_FALSE(unwritable.has_value());
  CHECK(unwritable.error().find("/nowhere/at_all.ply") != std::string::npos);
}

TEST_CASE("the NIST stairs and ramps come in as metres, z up, and can be placed") {
  const auto stairs_file = test::recorded_file("meshes/nist/stairs_120_solid.dae");
  const auto ramp_file = test::recorded_file("meshes/nist/full_ramp.dae");
  if (!stairs_file || !ramp_file) return;
  const auto stairs = import_mesh(*stairs_file);
  REQUIRE(stairs.has_value());
  CHECK(stairs->bounds().sizes().minCoeff() > 0.5F);
  CHECK(stairs->bounds().sizes().maxCoeff() < 4.0F);
  TriangleMesh world;
  world.append(*stairs, upright({10, 0, 0}, 0.0));
  world.append(*import_mesh(*ramp_file), upright({20, 0, 0}, 0.0));
  CHECK(world.bounds().min().x() > 5.0F);
  CHECK(world.bounds().max().x() < 25.0F);
}

TEST_CASE("the Edgar mine is 288 by 507 m of floor without the box that was left at its origin") {
  const auto file = test::recorded_file("meshes/edgar_mine.dae");
  if (!file) return;
  const auto mesh = import_mesh(*file, {.up = MeshImport::Up::kY, .leave_out = {"Cube"}});
  REQUIRE(mesh.has_value());
  CHECK(mesh->bounds().sizes().x() == doctest::Approx(287.0).epsilon(0.01));
  CHECK(mesh->bounds().sizes().y() == doctest::Approx(506.0).epsilon(0.01));
  CHECK(mesh->bounds().min().z() > -0.1F);
  CHECK(mesh->triangles.size() == 22545);
}

}  // namespace warren::world
