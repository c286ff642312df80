// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/octomap_reader.hpp"

#include <string>

#include <doctest/doctest.h>

#include "core/exchange/map_writer.hpp"
#include "tests/core/exchange/octomap_states.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/core/layer/random_codes.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using namespace warren::test;

namespace {

States states_of(const Replica& layer) {
  States states;
  layer.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    found.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      states[key_of_morton(block << 9 | place)] = code.state();
      if (code.state() == VoxelState::kOccupied) CHECK(code == VoxelCode::occupied(0, false));
    });
    return true;
  });
  return states;
}

// Noise, and cubes that OctoMap prunes to leaves of many sizes.
octomap::OcTree random_tree(std::uint64_t seed) {
  Random random(seed);
  octomap::OcTree tree(0.15);
  const auto set = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, bool occupied) {
    const auto axis = [](std::uint32_t at) { return static_cast<octomap::key_type>(32760 + at); };
    tree.updateNode(octomap::OcTreeKey(axis(x), axis(y), axis(z)), occupied ? 3.5F : -2.0F, true);
  };
  for (int count = 0; count < 300; ++count) {
    set(below(random, 90), below(random, 90), below(random, 90), chance(random, 50));
  }
  for (std::uint32_t place = 0; place < 32 * 32 * 32; ++place) {
    set(8 + place % 32, 8 + place / 32 % 32, 8 + place / 1024, seed % 2 == 0);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

std::string error_of(const std::string& bytes) {
  const auto tree = decode_octomap(bytes);
  REQUIRE_FALSE(tree);
  return tree.error().text;
}

const std::string kHeader = "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n";

}  // namespace

TEST_CASE("trees that OctoMap wrote have the voxels that OctoMap reads") {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    octomap::OcTree tree = random_tree(seed);
    REQUIRE(tree.writeBinary((folder / "tree.bt").string()));
    REQUIRE(tree.write((folder / "tree.ot").string()));
    const States expected = states_of(tree);
    for (const char* name : {"tree.bt", "tree.ot"}) {
      CAPTURE(name);
      const auto layer = read_octomap(folder / name, 9);
      REQUIRE_MESSAGE(layer, layer.error());
      CHECK(layer->resolution() == Resolution::from_metres(0.15));
      CHECK(layer->id().origin == 9);
      CHECK(states_of(*layer) == expected);
    }
  }
}

TEST_CASE("a map that was saved comes back, and the same file is the same layer") {
  const TemporaryFolder folder;
  MapSnapshot map{{}, SelfMap({0.1, SensorModel{}, false})};
  for (const auto& scan : walk_through_room(Room{}, Lidar{}, 3)) map.voxels.integrate(scan.view());
  for (const char* name : {"a.bt", "a.ot"}) {
    REQUIRE(save_map(map, folder / name));
    const auto layer = read_octomap(folder / name, 1);
    REQUIRE_MESSAGE(layer, layer.error());
    States expected;
    map.voxels.for_each_known_voxel(
        KeyBox{}, [&](const VoxelKey& key, VoxelState state, float) { expected[key] = state; });
    CHECK(states_of(*layer) == expected);
    CHECK(read_octomap(folder / name, 1)->id() == layer->id());
  }
  CHECK(read_octomap(folder / "a.bt", 1)->id() != read_octomap(folder / "a.ot", 1)->id());
}

TEST_CASE("a layer that was exported as a tree comes back without its costs") {
  const TemporaryFolder folder;
  Random random(1);
  BlockCodes codes = random_codes(random);
  Replica layer({1, 1, 1}, *Resolution::from_metres(0.2));
  layer.publish({{CodedBlock{kOrdinalEnd / 3, CodeBlock(codes)}}});
  States expected;
  layer.find(kOrdinalEnd / 3)->codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
    expected[key_of_morton(kOrdinalEnd / 3 << 9 | place)] = code.state();
  });
  for (const char* name : {"a.bt", "a.ot"}) {
    const auto saved = export_layer(layer, folder / name);
    REQUIRE_MESSAGE(saved, saved.error());
    CHECK(saved->voxels == expected.size());
    CHECK(states_of(*read_octomap(folder / name, 1)) == expected);
  }
  CHECK(export_layer(layer, folder / "a.png").error().find(".bt, .ot, .ply or .pcd") !=
        std::string::npos);
}

TEST_CASE("an empty tree is an empty layer") {
  const TemporaryFolder folder;
  octomap::OcTree tree(0.1);
  REQUIRE(tree.writeBinary((folder / "empty.bt").string()));
  REQUIRE(tree.write((folder / "empty.ot").string()));
  for (const char* name : {"empty.bt", "empty.ot"}) {
    const auto layer = read_octomap(folder / name, 1);
    REQUIRE_MESSAGE(layer, layer.error());
    CHECK(states_of(*layer).empty());
  }
}

TEST_CASE("what is no tree, or too deep, or too large, is refused with the reason") {
  CHECK(error_of("").find("first line") != std::string::npos);
  CHECK(
      error_of("# Octomap OcTree binary file\nid ColorOcTree\nres 0.1\ndata\n").find("id OcTree") !=
      std::string::npos);
  for (const char* res : {"0", "-1", "nan", "1e9", "0.1x", ""}) {
    CHECK(error_of(std::string("# Octomap OcTree file\nid OcTree\nres ") + res + "\ndata\n")
              .find("\"res\"") != std::string::npos);
  }
  CHECK(error_of("# Octomap OcTree file\nid OcTree\nres 0.1\n").find("data") != std::string::npos);
  CHECK(error_of(kHeader + std::string(100000, '\xFF')).find("16 levels") != std::string::npos);
  CHECK(error_of(kHeader + std::string("\x01\x00", 2)).find("more blocks") != std::string::npos);
  CHECK(error_of(kHeader + std::string("\0\0\0", 3)).find("follow") != std::string::npos);
}

TEST_CASE("a tree cut anywhere is refused, and altered bytes do no harm") {
  const TemporaryFolder folder;
  octomap::OcTree tree = random_tree(1);
  REQUIRE(tree.writeBinary((folder / "tree.bt").string()));
  REQUIRE(tree.write((folder / "tree.ot").string()));
  for (const char* name : {"tree.bt", "tree.ot"}) {
    std::string bytes = bytes_of(folder / name);
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 64) {
      REQUIRE_FALSE(decode_octomap(std::string_view(bytes).substr(0, length)));
    }
    for (std::size_t bit = 0; bit < bytes.size() * 8; bit += 1 + bit / 32) {
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
      const auto read = decode_octomap(bytes);
      if (read) REQUIRE(read->blocks.size() <= kOctomapBlocksMax);
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    }
  }
}
