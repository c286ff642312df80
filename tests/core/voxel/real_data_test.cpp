// SPDX-License-Identifier: Apache-2.0
// The self-map against OctoMap on recordings made by others. One case in every run; the matrix with
// WARREN_MATRIX=1 (tools/test --all).
#include <cstdlib>
#include <initializer_list>
#include <string>

#include <doctest/doctest.h>

#include "tests/support/recorded_data.hpp"
#include "tools/warren-bench/octomap_peer.hpp"
#include "tools/warren-bench/scan_sequence.hpp"

using namespace warren;

namespace {

struct Recording {
  const char* name;
  SequenceSource source;
};

bool want_matrix() {
  if (std::getenv("WARREN_MATRIX") != nullptr) return true;
  MESSAGE("SKIPPED: part of the matrix; set WARREN_MATRIX=1");
  return false;
}

void compare(const Recording& recording, const SelfMapConfig& config,
             std::optional<double> max_range_m) {
  const auto sequence = load_sequence(recording.source, config.resolution_m, max_range_m);
  REQUIRE_MESSAGE(sequence, sequence.error());
  SelfMap map(config);
  OctomapPeer peer(config);
  for (std::size_t i = 0; i < sequence->scans.size(); ++i) {
    map.integrate(sequence->scan(i));
    peer.insert(sequence->scan(i));
  }
  const MapAgreement a = peer.compare(map);
  MESSAGE("COUNTS: ", std::string(recording.name), ", ", config.resolution_m, " m, max range ",
          max_range_m.value_or(0.0), " m, ",
          std::string(config.sensor_model == SensorModel::field() ? "field" : "default"),
          " model, ", sequence->scans.size(), " scans: free ", a.free_ours, " ours, ", a.free_peer,
          " OctoMap, occupied ", a.occupied_ours, " ours, ", a.occupied_peer, " OctoMap, IoU ",
          a.iou_free(), " and ", a.iou_occupied());
  CHECK(a.identical());
  CHECK(a.free_ours > 0);
  CHECK(a.occupied_ours > 0);
}

void compare_all(const Recording& recording, std::initializer_list<double> resolutions_m) {
  for (const double resolution_m : resolutions_m) {
    for (const std::optional<double> max_range_m : {std::optional<double>{}, {20.0}}) {
      for (const SensorModel& model : {SensorModel::octomap_default(), SensorModel::field()}) {
        compare(recording, {resolution_m, model, false}, max_range_m);
      }
    }
  }
}

Recording balm(const std::filesystem::path& folder, std::size_t most_scans) {
  return {"balm_realworld", {folder, folder / "alidarPose.csv", PoseFormat::kMatrix4, most_scans}};
}

}  // namespace

TEST_CASE("balm_realworld gives OctoMap's map at 0.1 m and 20 m") {
  const test::UnpackedData data("scans/balm_realworld/balm_every2nd_frame.tar.xz");
  if (!data.is_there()) return;
  const Recording recording = balm(data.folder(), 16);
  compare(recording, {0.1, SensorModel{}, false}, 20.0);
  const auto sequence = load_sequence(recording.source, 0.1, 20.0);
  SelfMap map({0.1, SensorModel{}, false});
  for (std::size_t i = 0; i < sequence->scans.size(); ++i) map.integrate(sequence->scan(i));
  CHECK(map.counts().free > 1000000);
  CHECK(map.counts().occupied > 50000);
}

TEST_CASE("matrix: balm_realworld gives OctoMap's map at every setting") {
  if (!want_matrix()) return;
  const test::UnpackedData data("scans/balm_realworld/balm_every2nd_frame.tar.xz");
  if (!data.is_there()) return;
  compare_all(balm(data.folder(), 0), {0.1, 0.2});
  compare_all(balm(data.folder(), 20), {0.05});
  compare(balm(data.folder(), 0), {0.1, SensorModel{}, true}, 20.0);
}

TEST_CASE("matrix: the rooms give OctoMap's map at every setting") {
  if (!want_matrix()) return;
  for (const char* file : {"scans/pcl/room_scan1.pcd", "scans/pcl/room_scan2.pcd"}) {
    const auto path = test::recorded_file(file);
    if (!path) return;
    compare_all({file, {*path, std::nullopt, PoseFormat::kKitti, 0}}, {0.05, 0.1, 0.2});
  }
}

TEST_CASE("matrix: OctoMap's own sample scan gives OctoMap's map at every setting") {
  if (!want_matrix()) return;
  const test::UnpackedData data("scans/octomap/scan.dat.bz2");
  if (!data.is_there()) return;
  compare_all(
      {"octomap/scan.dat", {data.folder() / "scan.dat", std::nullopt, PoseFormat::kKitti, 0}},
      {0.05, 0.1, 0.2});
}
