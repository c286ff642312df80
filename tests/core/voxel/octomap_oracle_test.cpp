// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "core/voxel/self_map.hpp"
#include "tests/support/simulated_scans.hpp"
#include "tests/support/under_sanitizer.hpp"
#include "tools/warren-bench/octomap_peer.hpp"

using namespace warren;
using test::Lidar;
using test::Room;
using test::SimulatedScan;

namespace {

MapAgreement integrate_both(const SelfMapConfig& config, const std::vector<SimulatedScan>& scans,
                            std::optional<double> max_range_m) {
  SelfMap map(config);
  OctomapPeer peer(config);
  for (const SimulatedScan& scan : scans) {
    map.integrate(scan.view(max_range_m));
    peer.insert(scan.view(max_range_m));
  }
  return peer.compare(map);
}

}  // namespace

TEST_CASE("the self-map equals OctoMap's voxel by voxel") {
  const std::vector<SimulatedScan> walk =
      test::walk_through_room(Room{}, Lidar{}, test::kUnderSanitizer ? 2 : 6);
  for (const double resolution_m : {0.05, 0.1, 0.2}) {
    for (const SensorModel& model :
         {SensorModel::octomap_default(), SensorModel::field(), SensorModel::ours()}) {
      for (const std::optional<double> max_range_m : {std::optional<double>{}, {3.0}}) {
        for (const bool one_ray_per_end_voxel : {false, true}) {
          CAPTURE(resolution_m);
          CAPTURE(max_range_m.has_value());
          CAPTURE(one_ray_per_end_voxel);
          const MapAgreement agreement =
              integrate_both({resolution_m, model, one_ray_per_end_voxel}, walk, max_range_m);
          CHECK(agreement.identical());
          CHECK(agreement.free_ours > 1000);
          CHECK(agreement.occupied_ours > 100);
        }
      }
    }
  }
}

TEST_CASE("random clouds from random places give OctoMap's map") {
  const auto coordinate = rc::gen::map(rc::gen::inRange(-400, 400),
                                       [](int i) { return static_cast<float>(i) * 0.0125F; });
  const auto point = rc::gen::build<Point3f>(rc::gen::set(&Point3f::x, coordinate),
                                             rc::gen::set(&Point3f::y, coordinate),
                                             rc::gen::set(&Point3f::z, coordinate));
  CHECK(rc::check("identical to insertPointCloud", [&] {
    SelfMapConfig config{
        0.1, *rc::gen::element(SensorModel{}, SensorModel::field(), SensorModel::ours()), false};
    std::vector<SimulatedScan> scans;
    const int count = *rc::gen::inRange(1, 12);
    for (int i = 0; i < count; ++i) {
      scans.push_back({*point, *rc::gen::container<std::vector<Point3f>>(point)});
    }
    RC_ASSERT(integrate_both(config, scans, *rc::gen::element(2.5, 100.0)).identical());
  }));
}

TEST_CASE("a voxel that alternates between hit and pass keeps OctoMap's state") {
  const SelfMapConfig config;
  SelfMap map(config);
  OctomapPeer peer(config);
  std::mt19937 random(7);
  const SimulatedScan near{{0.05F, 0.05F, 0.05F}, {{1.05F, 0.05F, 0.05F}}};
  const SimulatedScan far{{0.05F, 0.05F, 0.05F}, {{2.05F, 0.05F, 0.05F}}};
  for (int i = 0; i < 500; ++i) {
    const LayerScan scan = (random() % 3 == 0 ? near : far).view();
    map.integrate(scan);
    peer.insert(scan);
    REQUIRE(peer.compare(map).identical());
  }
}

TEST_CASE("the oracle notices a single voxel's difference") {
  const SelfMapConfig config;
  SelfMap map(config);
  OctomapPeer peer(config);
  const SimulatedScan scan{{0.05F, 0.05F, 0.05F}, {{1.05F, 0.05F, 0.05F}}};
  const SimulatedScan other{{0.05F, 0.05F, 0.05F}, {{1.15F, 0.05F, 0.05F}}};
  map.integrate(scan.view());
  peer.insert(other.view());
  const MapAgreement agreement = peer.compare(map);
  CHECK_FALSE(agreement.identical());
  CHECK(agreement.iou_occupied() == 0.0);
  CHECK(agreement.iou_free() < 1.0);
}
