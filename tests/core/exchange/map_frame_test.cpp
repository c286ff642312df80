// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/map_frame.hpp"

#include <doctest/doctest.h>

using namespace warren;

namespace {

// One known voxel, (0, 0, 0); bounds are whole blocks.
MapSnapshot map_at(const LayerOrigin& origin) {
  MapSnapshot map{origin, SelfMap(SelfMapConfig{})};
  const std::vector<Point3f> points = {{0.05F, 0.05F, 0.05F}};
  map.voxels.integrate({{0.06F, 0.05F, 0.05F}, points, std::nullopt, {}});
  return map;
}

}  // namespace

TEST_CASE("trees are in the map frame up to the last block of the key space") {
  CHECK(frame_for_tree(place_of(map_at({32760, 0, -32768}))).note.empty());
  CHECK(frame_for_tree(place_of(map_at({32760, 0, -32768}))).shift ==
        LayerOrigin{32760, 0, -32768});
  CHECK_FALSE(frame_for_tree(place_of(map_at({32768, 0, 0}))).note.empty());
  CHECK(frame_for_tree(place_of(map_at({0, -32776, 0}))).shift == LayerOrigin{});
}

TEST_CASE("clouds are in the map frame as long as float32 is exact enough") {
  CHECK(frame_for_cloud(place_of(map_at({200'000, 0, 0}))).note.empty());
  CHECK(frame_for_cloud(place_of(map_at({10'000'000, 0, 8}))).note ==
        "layer frame (the map frame is too far from zero for float32): add 1000000.000 0.000 0.800 "
        "m to its coordinates for the map frame");
}
