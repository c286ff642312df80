// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/neighbourhood.hpp"

#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/core/terrain/clouds.hpp"
#include "tests/support/simulated_scans.hpp"

using namespace warren;

namespace {

struct Neighbour {
  float squared = 0.0F;
  std::uint32_t index = 0;
  friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
};

float squared_distance(const ReducedCloud& cloud, std::size_t a, std::size_t b) {
  const float x = cloud.x[b] - cloud.x[a];
  const float y = cloud.y[b] - cloud.y[a];
  const float z = cloud.z[b] - cloud.z[a];
  return (x * x + y * y) + z * z;
}

// By looking at all of them.
std::vector<Neighbour> nearest(const ReducedCloud& cloud, std::size_t to, std::size_t k) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    all.push_back({squared_distance(cloud, to, i), static_cast<std::uint32_t>(i)});
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(k, all.size()));
  std::sort(all.begin(), all.end(), [](auto a, auto b) { return a.index < b.index; });
  return all;
}

// How many of every n-th point have other neighbours than that.
std::size_t count_wrong(const ReducedCloud& cloud, std::uint32_t k, std::size_t every = 1) {
  NeighbourSearch search({k, std::nullopt});
  const auto listed = search.list(cloud);
  const Neighbourhoods& found = search.find(cloud);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); i += every) {
    if (cloud.size() < k) {
      wrong += found.states[i] == NeighbourhoodState::kTooFew ? 0 : 1;
      continue;
    }
    const auto wanted = nearest(cloud, i, k);
    float farthest = 0.0F;
    bool same = found.states[i] == NeighbourhoodState::kFound;
    for (std::size_t j = 0; j < k; ++j) {
      same = same && listed[i * k + j] == wanted[j].index;
      farthest = std::max(farthest, wanted[j].squared);
    }
    wrong += same && found.squared_radius[i] == farthest ? 0 : 1;
  }
  return wrong;
}

}  // namespace

TEST_CASE("the neighbours are those that looking at all points finds") {
  CHECK(rc::check("as brute force", [] {
    CloudReducer reducer(*rc::gen::element(0.05F, 0.01F));
    const ReducedCloud& cloud = reducer.reduce(test::arbitrary_cloud(200));
    RC_ASSERT(count_wrong(cloud, *rc::gen::element(1U, 3U, 24U, 40U)) == 0);
  }));
}

TEST_CASE("a scan of a room has the neighbours that looking at all points finds") {
  const auto scan = test::scan_room({}, {64, 512}, {0.1F, 0.2F, 0.3F}, 1);
  CloudReducer reducer(0.05F);
  CHECK(count_wrong(reducer.reduce(scan.points_layer), 24, 17) == 0);
}

TEST_CASE("of neighbours equally far, the first in the cloud count") {
  CloudReducer reducer(0.05F);
  std::vector<Point3f> grid;
  for (int i = 0; i < 1000; ++i) {
    const int layer = i / 100;
    const int row = i / 10 % 10;
    grid.push_back({static_cast<float>(i % 10) + 0.5F, static_cast<float>(row) + 0.5F,
                    static_cast<float>(layer) + 0.5F});
  }
  CHECK(count_wrong(reducer.reduce(grid), 24) == 0);
}

TEST_CASE("with a maximum radius, neighbourhoods are the same or too wide") {
  CHECK(rc::check("bounded", [] {
    CloudReducer reducer(0.05F);
    const ReducedCloud& cloud = reducer.reduce(test::arbitrary_cloud(200));
    const float most = *rc::gen::element(0.05F, 0.2F, 1.0F, 30.0F);
    NeighbourSearch bounded({24, most});
    NeighbourSearch unbounded({24, std::nullopt});
    const auto listed = bounded.list(cloud);
    const Neighbourhoods found = bounded.find(cloud);
    const auto all = unbounded.list(cloud);
    const Neighbourhoods& any_width = unbounded.find(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool within = any_width.states[i] == NeighbourhoodState::kFound &&
                          any_width.squared_radius[i] <= most * most;
      RC_ASSERT((found.states[i] == NeighbourhoodState::kFound) == within);
      for (std::size_t j = 0; j < 24 && within; ++j) {
        RC_ASSERT(listed[i * 24 + j] == all[i * 24 + j]);
      }
    }
  }));
}

TEST_CASE("every instruction set finds the same bits") {
  const auto scan = test::scan_room({}, {32, 256}, {0.1F, 0.2F, 0.3F}, 2);
  CloudReducer reducer(0.05F);
  const ReducedCloud& cloud = reducer.reduce(scan.points_layer);
  NeighbourSearch search({});
  const Neighbourhoods wanted = search.find(cloud);
  int targets = 0;
  test::on_every_target([&] {
    ++targets;
    const Neighbourhoods& found = search.find(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      REQUIRE(found.states[i] == wanted.states[i]);
      REQUIRE(found.squared_radius[i] == wanted.squared_radius[i]);
      for (std::size_t j = 0; j < 9; ++j) REQUIRE(found.moments[j][i] == wanted.moments[j][i]);
    }
  });
  CHECK(targets >= 2);
}
