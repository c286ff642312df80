// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "core/exchange/image.hpp"
#include "core/exchange/map_relief.hpp"
#include "core/exchange/map_writer.hpp"
#include "tests/core/exchange/read_picture.hpp"
#include "tests/core/exchange/temporary_folder.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;
using namespace warren::test;

namespace {

SelfMap room_map(double resolution_m) {
  SelfMap map({resolution_m, SensorModel{}, false});
  for (const auto& scan : walk_through_room(Room{}, Lidar{}, 5)) map.integrate(scan.view());
  return map;
}

}  // namespace

TEST_CASE("a map becomes a picture, the same each time") {
  const TemporaryFolder folder;
  const MapSnapshot map{LayerOrigin{}, room_map(0.1)};
  REQUIRE(save_map(map, folder / "a.png"));
  REQUIRE(save_map(map, folder / "b.png"));
  CHECK(bytes_of(folder / "a.png") == bytes_of(folder / "b.png"));
  const Picture picture = read_png(folder / "a.png");
  CHECK(picture.width == 1600);
  CHECK(picture.height == 900);
  CHECK(picture.colours() > 500);
}

TEST_CASE("a picture of costs is black where ground is easy, white where hard, red without data") {
  const TemporaryFolder folder;
  MapSnapshot map{LayerOrigin{}, room_map(0.1)};
  const auto red_pixels = [&] {
    REQUIRE(save_map(map, folder / "cost.png", PictureColours::kCost));
    const Picture picture = read_png(folder / "cost.png");
    std::size_t red = 0;
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
      red += picture.rgb[i] > 100 && picture.rgb[i + 1] < picture.rgb[i] / 2 ? 1 : 0;
    }
    return red;
  };
  const std::size_t all_unknown = red_pixels();
  CHECK(all_unknown > 50000);
  std::vector<VoxelCost> costs;
  map.voxels.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
    if (state == VoxelState::kOccupied) costs.push_back({key, key.x < 0 ? 0.0F : 1.0F, 1.0F});
  });
  map.voxels.fuse_costs(costs);
  CHECK(red_pixels() < 1000);  // the legend's
  const Picture picture = read_png(folder / "cost.png");
  std::size_t black = 0;
  std::size_t white = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    const bool is_grey =
        picture.rgb[i] == picture.rgb[i + 1] && picture.rgb[i] == picture.rgb[i + 2];
    black += is_grey && picture.rgb[i] < 10 ? 1 : 0;
    white += is_grey && picture.rgb[i] > 200 ? 1 : 0;
  }
  CHECK(black > 20000);
  CHECK(white > 20000);
}

TEST_CASE("the ceiling is left out, floor and walls are not") {
  const double resolution_m = 0.1;
  const MapSnapshot snapshot{LayerOrigin{}, room_map(resolution_m)};
  const SelfMap& map = snapshot.voxels;
  const MapRelief relief(exported(snapshot), *map.bounds());
  // The room is 3 m high around z = 0, the floor at -1.5 m.
  CHECK(relief.is_shown(*map.lattice().key_of(1.0, 1.0, -1.5)));
  CHECK(relief.is_shown(*map.lattice().key_of(6.0, 1.0, 0.0)));
  CHECK_FALSE(relief.is_shown(*map.lattice().key_of(1.0, 1.0, 1.5)));
  REQUIRE(relief.extent());
  CHECK(relief.extent()->high.z < map.lattice().key_of(0.0, 0.0, 1.0)->z);
}

TEST_CASE("a map as wide as the key space takes a bounded raster") {
  const TemporaryFolder folder;
  MapSnapshot map{LayerOrigin{}, SelfMap({0.1, SensorModel{}, false})};
  for (const Point3f& corner :
       {Point3f{-3276.7F, -3276.7F, -3276.7F}, Point3f{3276.6F, 3276.6F, 3276.6F}}) {
    const std::vector<Point3f> points = {corner};
    map.voxels.integrate({corner, points, std::nullopt, {}});
  }
  REQUIRE(map.voxels.counts().occupied == 2);
  CHECK(save_map(map, folder / "a.png"));
}

TEST_CASE("drawing outside of an image is cut off") {
  Image image(20, 10, Colour{1, 2, 3});
  image.fill({-5, -5, 8, 8}, Colour{9, 9, 9});
  image.draw_text(15, 5, "0123", Colour{255, 255, 255});
  image.draw_text(-400, -3, "abc\x80\xff", Colour{255, 255, 255});
  CHECK(image.at(2, 2).red == 9);
  CHECK(image.at(3, 3).red == 1);
}
