// SPDX-License-Identifier: Apache-2.0
// What files of a merge-map tell.
#include <cmath>
#include <cstring>
#include <memory>

#include <doctest/doctest.h>
#include <octomap/OcTree.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/map_writer.hpp"
#include "core/exchange/source_legend.hpp"
#include "tests/core/exchange/merged_rooms.hpp"
#include "tests/core/exchange/read_picture.hpp"
#include "tests/core/exchange/temporary_folder.hpp"

using namespace warren;
using namespace warren::test;

namespace {

const Eigen::Vector3d kOrigin_m{-1.6, 0.8, 0.0};

struct CloudPoint {
  Point3f position;
  float cost = 0.0F;
  std::uint32_t source = 0;
  std::uint32_t rgb = 0;
};

std::vector<CloudPoint> points_of(const MergedSnapshot& snapshot) {
  std::vector<CloudPoint> points;
  snapshot.for_each_known([&](const VoxelKey& key, VoxelCode code, SourceNumber source) {
    if (code.state() != VoxelState::kOccupied) return;
    const Colour colour = colour_of_source(source);
    const auto centre = [](std::int64_t moved) {
      return static_cast<float>((static_cast<double>(moved) + 0.5) * MergedRooms::kResolution_m);
    };
    const LayerOrigin& origin = snapshot.origin();
    points.push_back(
        {{centre(key.x + origin.x), centre(key.y + origin.y), centre(key.z + origin.z)},
         decode_cost(code.cost()).value_or(NAN),
         source,
         std::uint32_t{colour.red} << 16 | std::uint32_t{colour.green} << 8 | colour.blue});
  });
  return points;
}

template <typename Value>
Value field_of(const pcl::PCLPointCloud2& cloud, const char* name, std::size_t point) {
  const int index = pcl::getFieldIndex(cloud, name);
  REQUIRE(index >= 0);
  const auto offset = cloud.fields[static_cast<std::size_t>(index)].offset;
  Value value{};
  std::memcpy(&value, &cloud.data[point * cloud.point_step + offset], sizeof value);
  return value;
}

bool same(const CloudPoint& point, const pcl::PCLPointCloud2& cloud, std::size_t i) {
  const auto cost = field_of<float>(cloud, "cost", i);
  return field_of<float>(cloud, "x", i) == point.position.x &&
         field_of<float>(cloud, "y", i) == point.position.y &&
         field_of<float>(cloud, "z", i) == point.position.z &&
         (cost == point.cost || (std::isnan(cost) && std::isnan(point.cost))) &&
         field_of<std::uint32_t>(cloud, "source", i) == point.source &&
         (field_of<std::uint32_t>(cloud, "rgb", i) & 0xFFFFFFU) == point.rgb;
}

}  // namespace

TEST_CASE("PCL reads whose word each voxel of a saved merge-map is, and its colour") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), kOrigin_m);
  const std::vector<CloudPoint> expected = points_of(snapshot);
  for (const char* name : {"merged.pcd", "merged.ply"}) {
    CAPTURE(name);
    const auto saved = save_merged_map(snapshot, folder / name);
    REQUIRE_MESSAGE(saved, saved.error());
    CHECK(saved->voxels == expected.size());
    CHECK(saved->note.empty());
    pcl::PCLPointCloud2 cloud;
    const std::string file = (folder / name).string();
    REQUIRE((saved->format == "pcd" ? pcl::io::loadPCDFile(file, cloud)
                                    : pcl::io::loadPLYFile(file, cloud)) >= 0);
    REQUIRE(cloud.width * cloud.height == expected.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      different += same(expected[i], cloud, i) ? 0 : 1;
    }
    CHECK(different == 0);
    CHECK(read_cloud(folder / name).value().points.size() == expected.size());
  }
}

TEST_CASE("the headers of merged clouds tell which number is which layer") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  MergedSnapshot snapshot = snapshot_of(rooms.map(), kOrigin_m);
  snapshot.name_others([](const LayerId& layer) { return layer.origin == 7 ? "robot-2" : ""; });
  REQUIRE(save_merged_map(snapshot, folder / "a.ply"));
  CHECK(bytes_of(folder / "a.ply")
            .starts_with("ply\nformat binary_little_endian 1.0\n"
                         "comment source 0: this robot\n"
                         "comment source 1: robot 7 layer 2 incarnation 00000000000000cd robot-2\n"
                         "comment source 2: robot 9 layer 1 incarnation 00000000000000ab\n"
                         "element vertex " +
                         std::to_string(snapshot.counts().occupied) +
                         "\nproperty float x\nproperty float y\nproperty float z\n"
                         "property float p\nproperty float cost\nproperty uint source\n"
                         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "end_header\n"));
  REQUIRE(save_merged_map(snapshot, folder / "a.pcd"));
  const std::string pcd = bytes_of(folder / "a.pcd");
  CHECK(pcd.starts_with("# .PCD v0.7"));
  CHECK(pcd.find("\n# source 2: robot 9 layer 1 incarnation 00000000000000ab\nVERSION") !=
        std::string::npos);
  CHECK(pcd.find("\nFIELDS x y z p cost source rgb\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F U F\n") !=
        std::string::npos);
}

TEST_CASE("a picture names the node whose word a voxel is, or its number") {
  CHECK(short_name_of({7, 2, 0xcd}, "robot-2") == "robot-2 layer 2");
  CHECK(short_name_of({7, 2, 0xcd}, "") == "robot 7 layer 2");
}

TEST_CASE("the cloud of a robot's own map has neither source nor colour") {
  const TemporaryFolder folder;
  MapSnapshot map{LayerOrigin{}, SelfMap(SelfMapConfig{})};
  const std::vector<Point3f> points = {{0.05F, 0.05F, 0.05F}};
  map.voxels.integrate({{0.06F, 0.05F, 0.05F}, points, std::nullopt, {}});
  REQUIRE(save_map(map, folder / "own.ply"));
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float p\nproperty float cost\nend_header\n";
  const std::string bytes = bytes_of(folder / "own.ply");
  CHECK(bytes.starts_with(header));
  CHECK(bytes.size() == header.size() + 5 * sizeof(float));
}

TEST_CASE("OctoMap reads the states of a saved merge-map, in the map frame") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), kOrigin_m);
  REQUIRE(save_merged_map(snapshot, folder / "merged.bt"));
  REQUIRE(save_merged_map(snapshot, folder / "merged.ot"));
  octomap::OcTree binary(1.0);
  REQUIRE(binary.readBinary((folder / "merged.bt").string()));
  const std::unique_ptr<octomap::AbstractOcTree> full(
      octomap::AbstractOcTree::read((folder / "merged.ot").string()));
  REQUIRE(full != nullptr);
  for (octomap::OcTree* const tree : {&binary, dynamic_cast<octomap::OcTree*>(full.get())}) {
    REQUIRE(tree != nullptr);
    tree->expand();
    CHECK(tree->getNumLeafNodes() == snapshot.counts().free + snapshot.counts().occupied);
    std::size_t different = 0;
    const LayerOrigin& origin = snapshot.origin();
    snapshot.for_each_known([&](const VoxelKey& key, VoxelCode code, SourceNumber) {
      const auto axis = [](std::int64_t moved) {
        return static_cast<octomap::key_type>(moved - kKeyMin);
      };
      const auto* const node = tree->search(octomap::OcTreeKey(
          axis(key.x + origin.x), axis(key.y + origin.y), axis(key.z + origin.z)));
      const bool is_occupied = code.state() == VoxelState::kOccupied;
      different += node != nullptr && tree->isNodeOccupied(node) == is_occupied ? 0 : 1;
    });
    CHECK(different == 0);
  }
}

TEST_CASE("a picture by source shows each layer in its colour, with a legend, the same each time") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  const MergedSnapshot all = snapshot_of(rooms.map(), kOrigin_m);
  REQUIRE(save_merged_map(all, folder / "a.png", PictureColours::kSource));
  REQUIRE(save_merged_map(all, folder / "b.png", PictureColours::kSource));
  CHECK(bytes_of(folder / "a.png") == bytes_of(folder / "b.png"));
  const Picture picture = read_png(folder / "a.png");
  for (SourceNumber source = 0; source <= 2; ++source) {
    CAPTURE(source);
    CHECK(picture.pixels_like(colour_of_source(source)) > 5000);
  }
  CHECK(picture.pixels_like(colour_of_source(3)) == 0);

  REQUIRE(rooms.map().retract_layer(MergedRooms::kEast) == MergeResult::kDone);
  REQUIRE(save_merged_map(snapshot_of(rooms.map(), kOrigin_m), folder / "a.png"));
  CHECK(read_png(folder / "a.png").pixels_like(colour_of_source(2)) == 0);
}

TEST_CASE("a merge-map is drawn by height and by cost as well") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), kOrigin_m);
  for (const PictureColours colours : {PictureColours::kHeight, PictureColours::kCost}) {
    REQUIRE(save_merged_map(snapshot, folder / "a.png", colours));
    const Picture picture = read_png(folder / "a.png");
    CHECK(picture.colours() > 200);
    CHECK(picture.pixels_like(colour_of_source(1)) == 0);
  }
}

TEST_CASE("sources beyond the colours share a grey") {
  const TemporaryFolder folder;
  MergedRooms rooms;
  for (std::uint32_t i = 0; i < 10; ++i) {
    rooms.add_room({20 + i, 1 + i % 3, i}, {-9.0 * (i % 4), -6.0 * (1 + i / 4), 0.0});
  }
  const MergedSnapshot snapshot = snapshot_of(rooms.map(), kOrigin_m);
  REQUIRE(snapshot.others().size() == 12);
  REQUIRE(save_merged_map(snapshot, folder / "a.png"));
  const Picture picture = read_png(folder / "a.png");
  for (SourceNumber source = 0; source <= 8; ++source) {
    CAPTURE(source);
    CHECK(picture.pixels_like(colour_of_source(source)) > 500);
  }
  CHECK(picture.pixels_like(colour_of_source(8)) > picture.pixels_like(colour_of_source(7)));
}

TEST_CASE("an empty merge-map makes files that can be read; an unknown ending is refused") {
  const TemporaryFolder folder;
  MergeMap map({0.1});
  const MergedSnapshot snapshot = snapshot_of(map, Eigen::Vector3d::Zero());
  for (const char* name : {"a.bt", "a.ot", "a.ply", "a.pcd", "a.png"}) {
    CAPTURE(name);
    const auto saved = save_merged_map(snapshot, folder / name);
    REQUIRE_MESSAGE(saved, saved.error());
    CHECK(saved->voxels == 0);
  }
  CHECK(read_cloud(folder / "a.ply").value().points.empty());
  CHECK(read_cloud(folder / "a.pcd").value().points.empty());
  CHECK_FALSE(save_merged_map(snapshot, folder / "a.las"));
}
