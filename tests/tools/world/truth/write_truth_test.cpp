// SPDX-License-Identifier: Apache-2.0
#include "tools/world/truth/write_truth.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "core/exchange/pose_file.hpp"
#include "tests/tools/world/hand_made.hpp"

using namespace warren::world;

namespace {

class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "warren-test-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

World hall_with_stairs() {
  World world;
  world.mesh = test::room({3.0F, 3.0F, 1.5F});
  world.start = {-1.5, 0.0, -1.5};
  world.stairways.push_back({.foot = {1.0, 0.0, -1.5},
                             .yaw_rad = 0.0,
                             .steps = 4,
                             .rise_m = 0.17,
                             .run_m = 0.3,
                             .width_m = 1.2});
  return world;
}

SimulationSpec one_robot() {
  SimulationSpec spec;
  spec.duration_s = 2.0;
  spec.robots.resize(1);
  spec.robots[0].name = "alpha";
  spec.robots[0].odometry.scale = 0.1;
  spec.robots[0].route = {{-1.5, 0.0, -1.5}, {0.5, 0.0, -1.5}};
  return spec;
}

}  // namespace

TEST_CASE("the truth is written whole, and the same every time") {
  const World world = hall_with_stairs();
  const Simulation simulation(world, one_robot());
  const Folder folder;
  REQUIRE(write_truth(folder / "a", simulation));
  REQUIRE(write_truth(folder / "b", simulation));
  for (const char* name :
       {"mesh.ply", "cloud.ply", "surfaces.json", "stairs.json", "drivability.csv",
        "trajectory_alpha.txt", "believed_alpha.txt", "frames.json"})
    CHECK(content(folder / "a" / name) == content(folder / "b" / name));
}

TEST_CASE("what is written can be read again and says what the simulation says") {
  const World world = hall_with_stairs();
  const Simulation simulation(world, one_robot());
  const Folder folder;
  REQUIRE(write_truth(folder / "", simulation));
  const auto stairs = nlohmann::json::parse(content(folder / "stairs.json"));
  REQUIRE(stairs["stairways"].size() == 1);
  CHECK(stairs["stairways"][0]["steps"] == 4);
  CHECK(stairs["stairways"][0]["edges"].size() == world.stairways[0].edges().size());
  const auto surfaces = nlohmann::json::parse(content(folder / "surfaces.json"));
  CHECK(surfaces["wall"]["samples"] == 14400);  // 144 m2, 0.1 m
  CHECK(surfaces["wall"]["seen"] > 5000);
  CHECK(surfaces["wall"]["seen"] < 14400);  // not the floor below the beams
  const auto poses = warren::read_poses(folder / "trajectory_alpha.txt", warren::PoseFormat::kTum);
  REQUIRE(poses);
  CHECK(poses->size() == 21);
  const auto believed = warren::read_poses(folder / "believed_alpha.txt", warren::PoseFormat::kTum);
  REQUIRE(believed);
  CHECK(believed->size() == 21);
  const std::string table = content(folder / "drivability.csv");
  CHECK(table.starts_with("x_m,y_m,z_m,husky_stand,husky_move\n"));
  CHECK(table.find("0.000,0.000,-1.500,1.000,1.000\n") != std::string::npos);
}

TEST_CASE("a folder that cannot be made is an error") {
  const World world = hall_with_stairs();
  const Simulation simulation(world, one_robot());
  CHECK_FALSE(write_truth("/proc/nowhere", simulation));
}
