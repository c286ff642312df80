// SPDX-License-Identifier: Apache-2.0
// PCL writes, we read; we write, PCL reads.
#include <cmath>
#include <cstring>
#include <random>

#include <doctest/doctest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/map_writer.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using namespace warren::test;

namespace {

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void check_same(const std::vector<Point3f>& ours, const pcl::PointCloud<pcl::PointXYZ>& theirs) {
  REQUIRE(ours.size() == theirs.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const pcl::PointXYZ& p = theirs[i];
    if (!same(ours[i].x, p.x) || !same(ours[i].y, p.y) || !same(ours[i].z, p.z)) ++different;
  }
  CHECK(different == 0);
}

pcl::PointCloud<pcl::PointXYZINormal> random_cloud(std::size_t points) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> metres(-30.0F, 30.0F);
  pcl::PointCloud<pcl::PointXYZINormal> cloud;
  for (std::size_t i = 0; i < points; ++i) {
    pcl::PointXYZINormal p;
    p.x = i % 5 == 0 ? std::nanf("") : metres(random);
    p.y = metres(random);
    p.z = i % 3 == 0 ? 0.0F : metres(random);
    p.intensity = 1.0F;
    cloud.push_back(p);
  }
  return cloud;
}

template <typename P>
pcl::PointCloud<pcl::PointXYZ> xyz_of(const pcl::PointCloud<P>& cloud) {
  pcl::PointCloud<pcl::PointXYZ> xyz;
  for (const P& p : cloud) xyz.push_back({p.x, p.y, p.z});
  return xyz;
}

void give_costs_to_half(SelfMap& map) {
  std::vector<VoxelCost> costs;
  map.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
    if (state != VoxelState::kOccupied || (key.x + key.y + key.z) % 2 != 0) return;
    costs.push_back({key, static_cast<float>(costs.size() % 100) / 100.0F, 1.0F});
  });
  map.fuse_costs(costs);
}

float field_of(const pcl::PCLPointCloud2& cloud, const char* name, std::size_t point) {
  const int index = pcl::getFieldIndex(cloud, name);
  REQUIRE(index >= 0);
  float value = 0.0F;
  const auto offset = cloud.fields[static_cast<std::size_t>(index)].offset;
  std::memcpy(&value, &cloud.data[point * cloud.point_step + offset], sizeof value);
  return value;
}

}  // namespace

TEST_CASE("clouds written by PCL in every PCD encoding are read as they were") {
  const TemporaryFolder folder;
  const auto cloud = random_cloud(1000);
  pcl::PCDWriter writer;
  writer.writeASCII((folder / "ascii.pcd").string(), cloud, 9);
  writer.writeBinary((folder / "binary.pcd").string(), cloud);
  writer.writeBinaryCompressed((folder / "compressed.pcd").string(), cloud);
  for (const char* name : {"ascii.pcd", "binary.pcd", "compressed.pcd"}) {
    CAPTURE(name);
    const auto ours = read_cloud(folder / name);
    REQUIRE_MESSAGE(ours, ours.error());
    check_same(ours->points, xyz_of(cloud));
  }
}

TEST_CASE("clouds written by PCL as PLY are read as they were") {
  const TemporaryFolder folder;
  auto cloud = random_cloud(100);
  for (auto& p : cloud) p.x = std::isnan(p.x) ? 1.0F : p.x;
  pcl::PCLPointCloud2 generic;
  pcl::toPCLPointCloud2(cloud, generic);
  for (const bool binary : {false, true}) {
    pcl::PLYWriter().write((folder / "a.ply").string(), generic, Eigen::Vector4f::Zero(),
                           Eigen::Quaternionf::Identity(), binary, true);
    const auto ours = read_cloud(folder / "a.ply");
    REQUIRE_MESSAGE(ours, ours.error());
    REQUIRE(ours->points.size() == cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      CHECK(ours->points[i].x == doctest::Approx(cloud[i].x).epsilon(1e-4));
      CHECK(ours->points[i].z == doctest::Approx(cloud[i].z).epsilon(1e-4));
    }
  }
}

TEST_CASE("an empty cloud written by PCL is an empty cloud") {
  const TemporaryFolder folder;
  folder.write("a.pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA ascii\n");
  CHECK(read_cloud(folder / "a.pcd").value().points.empty());
}

TEST_CASE("recorded clouds are read as PCL reads them") {
  for (const char* name : {"scans/pcl/room_scan1.pcd", "scans/pcl/room_scan2.pcd",
                           "stairs/shiaoming/0001_cloud.pcd"}) {
    const auto file = recorded_file(name);
    if (!file) return;
    pcl::PointCloud<pcl::PointXYZ> theirs;
    REQUIRE(pcl::io::loadPCDFile(file->string(), theirs) == 0);
    const auto ours = read_cloud(*file);
    REQUIRE_MESSAGE(ours, ours.error());
    check_same(ours->points, theirs);
  }
  const auto ply = recorded_file("scans/small_gicp/source.ply");
  if (!ply) return;
  pcl::PointCloud<pcl::PointXYZ> theirs;
  REQUIRE(pcl::io::loadPLYFile(ply->string(), theirs) == 0);
  check_same(read_cloud(*ply).value().points, theirs);
}

TEST_CASE("PCL reads the occupied voxel centres, probabilities and costs of a saved map") {
  const TemporaryFolder folder;
  MapSnapshot map{LayerOrigin{800, -1600, 8}, SelfMap(SelfMapConfig{})};
  for (const auto& scan : walk_through_room(Room{}, Lidar{}, 3)) map.voxels.integrate(scan.view());
  give_costs_to_half(map.voxels);
  for (const char* name : {"map.pcd", "map.ply"}) {
    CAPTURE(name);
    const auto saved = save_map(map, folder / name);
    REQUIRE_MESSAGE(saved, saved.error());
    CHECK(saved->note.empty());
    CHECK(saved->voxels == map.voxels.counts().occupied);
    pcl::PCLPointCloud2 generic;
    const bool is_pcd = std::string(name) == "map.pcd";
    REQUIRE((is_pcd ? pcl::io::loadPCDFile((folder / name).string(), generic)
                    : pcl::io::loadPLYFile((folder / name).string(), generic)) == 0);
    REQUIRE(generic.width * generic.height == saved->voxels);
    std::size_t without_cost = 0;
    pcl::PointCloud<pcl::PointXYZ> points;
    pcl::fromPCLPointCloud2(generic, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto key =
          map.voxels.lattice().key_of(points[i].x - 80.0, points[i].y + 160.0, points[i].z - 0.8);
      REQUIRE(key);
      REQUIRE(map.voxels.state(*key) == VoxelState::kOccupied);
      REQUIRE(field_of(generic, "p", i) ==
              doctest::Approx(1.0 / (1.0 + std::exp(-*map.voxels.log_odds(*key)))));
      const auto cost = map.voxels.cost(*key);
      without_cost += cost ? 0 : 1;
      if (cost) REQUIRE(field_of(generic, "cost", i) == *cost);
      if (!cost) REQUIRE(std::isnan(field_of(generic, "cost", i)));
    }
    CHECK(without_cost == map.voxels.cost_counts().no_data);
    CHECK(without_cost > 100);
    CHECK(without_cost < points.size() - 100);
  }
}
