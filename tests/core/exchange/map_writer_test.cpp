// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_writer.hpp"

#include <csignal>
#include <memory>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include "tests/core/exchange/octomap_states.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using namespace warren::test;

namespace {

MapSnapshot room_map(const LayerOrigin& origin, const SensorModel& model = SensorModel{}) {
  MapSnapshot map{origin, SelfMap({0.1, model, false})};
  for (const auto& scan : walk_through_room(Room{}, Lidar{}, 5)) map.voxels.integrate(scan.view());
  return map;
}

States states_of(const MapSnapshot& map, const LayerOrigin& shift) {
  States states;
  const auto moved = [](std::int32_t key, std::int64_t by) {
    return static_cast<std::int32_t>(key + by);
  };
  map.voxels.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, VoxelState state, float) {
    states[{moved(key.x, shift.x), moved(key.y, shift.y), moved(key.z, shift.z)}] = state;
  });
  return states;
}

std::unique_ptr<octomap::OcTree> read_tree(const std::filesystem::path& file) {
  if (file.extension() == ".bt") {
    auto tree = std::make_unique<octomap::OcTree>(1.0);
    return tree->readBinary(file.string()) ? std::move(tree) : nullptr;
  }
  std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file.string()));
  auto* const occupancy = dynamic_cast<octomap::OcTree*>(tree.get());
  if (occupancy != nullptr) static_cast<void>(tree.release());
  return std::unique_ptr<octomap::OcTree>(occupancy);
}

}  // namespace

TEST_CASE("OctoMap reads back the same free and occupied voxels, in the map frame") {
  const TemporaryFolder folder;
  for (const SensorModel& model : {SensorModel::octomap_default(), SensorModel::field()}) {
    const MapSnapshot map = room_map({-160, 8, 24}, model);
    const MapCounts counts = map.voxels.counts();
    REQUIRE(counts.occupied > 1000);
    for (const char* name : {"map.bt", "map.ot", "map.OT"}) {
      CAPTURE(name);
      const auto saved = save_map(map, folder / name);
      REQUIRE_MESSAGE(saved, saved.error());
      CHECK(saved->format == (std::string(name) == "map.bt" ? "bt" : "ot"));
      CHECK(saved->voxels == counts.free + counts.occupied);
      CHECK(saved->bytes == std::filesystem::file_size(folder / name));
      CHECK(saved->note.empty());
      const auto tree = read_tree(folder / name);
      REQUIRE(tree);
      CHECK(tree->getResolution() == 0.1);
      CHECK(states_of(*tree) == states_of(map, map.origin));
    }
  }
}

TEST_CASE("an .ot file keeps the log-odds and is pruned") {
  const TemporaryFolder folder;
  const MapSnapshot map = room_map({});
  REQUIRE(save_map(map, folder / "map.ot"));
  const auto tree = read_tree(folder / "map.ot");
  REQUIRE(tree);
  const std::size_t nodes = tree->size();
  tree->prune();
  CHECK(tree->size() == nodes);
  tree->expand();
  CHECK(nodes < tree->size());
  tree->prune();
  map.voxels.for_each_known_voxel(KeyBox{}, [&](const VoxelKey& key, VoxelState, float log_odds) {
    const Lattice& lattice = map.voxels.lattice();
    const auto* const node =
        tree->search(lattice.centre_m(key.x), lattice.centre_m(key.y), lattice.centre_m(key.z));
    REQUIRE(node != nullptr);
    REQUIRE(node->getLogOdds() == doctest::Approx(log_odds).epsilon(1e-3));
  });
}

TEST_CASE("a layer too far away for OctoMap's keys is written in its own frame, with a note") {
  const TemporaryFolder folder;
  const MapSnapshot map = room_map({32768, 0, -8});
  for (const char* name : {"map.bt", "map.ot"}) {
    const auto saved = save_map(map, folder / name);
    REQUIRE(saved);
    CHECK(saved->note.find("add 3276.800 0.000 -0.800 m") != std::string::npos);
    const auto tree = read_tree(folder / name);
    REQUIRE(tree);
    CHECK(states_of(*tree) == states_of(map, {}));
  }
}

TEST_CASE("an empty map makes files that can be read") {
  const TemporaryFolder folder;
  const MapSnapshot map{LayerOrigin{}, SelfMap(SelfMapConfig{})};
  for (const char* name : {"a.bt", "a.ot", "a.ply", "a.pcd", "a.png"}) {
    CAPTURE(name);
    const auto saved = save_map(map, folder / name);
    REQUIRE_MESSAGE(saved, saved.error());
    CHECK(saved->voxels == 0);
  }
  for (const char* name : {"a.bt", "a.ot"}) {
    const auto tree = read_tree(folder / name);
    REQUIRE(tree);
    CHECK(tree->size() == 0);
  }
}

TEST_CASE("an unknown ending is refused and names the known ones") {
  const TemporaryFolder folder;
  const auto saved = save_map(room_map({}), folder / "map.las");
  REQUIRE_FALSE(saved);
  CHECK(saved.error() == "cannot write " + (folder / "map.las").string() +
                             ": the ending must be .bt, .ot, .ply, .pcd or .png");
  CHECK(folder.files() == 0);
}

TEST_CASE("a folder that is not there or a name that is a folder is an error") {
  const TemporaryFolder folder;
  CHECK(save_map(room_map({}), folder / "none/map.bt").error() ==
        "cannot write " + (folder / "none/map.bt").string() + ": No such file or directory");
  std::filesystem::create_directory(folder / "map.bt");
  CHECK_FALSE(save_map(room_map({}), folder / "map.bt"));
  CHECK(folder.files() == 1);
}

TEST_CASE("a disk that takes no more leaves the old file and nothing else") {
  const TemporaryFolder folder;
  const MapSnapshot map = room_map({});
  // A limit on the size of files stands for the full disk.
  rlimit old_limit{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
  auto* const old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const char* name : {"map.bt", "map.ot", "map.ply", "map.pcd", "map.png"}) {
    CAPTURE(name);
    folder.write(name, "old");
    const rlimit small{1024, old_limit.rlim_max};
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    const auto saved = save_map(map, folder / name);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &old_limit) == 0);
    CHECK_FALSE(saved);
    CHECK(bytes_of(folder / name) == "old");
  }
  std::signal(SIGXFSZ, old_handler);
  CHECK(folder.files() == 5);
}
