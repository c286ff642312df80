// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/voxel/point.hpp"
#include "tools/world/vehicle.hpp"
#include "tools/world/world.hpp"

namespace warren {

// Whether a vehicle lowered on the mesh can use a place. A mixed one depends on the heading, which
// a cost does not know, so costs are not judged by it.
enum class GroundLabel : std::uint8_t {
  kSafe,    // it can stand and drive a step ahead at every heading
  kMixed,   // at half of them or more
  kHazard,  // at less than half
};

struct GroundPlace {
  Point3f position_world;
  std::vector<GroundLabel> by_vehicle;
};

struct PlaceInView {
  std::size_t place = 0;
  double range_m = 0.0;  // from the sensor
};

struct LabelledScan {
  std::vector<Point3f> points_world;
  Point3f origin_world;
  // Places in the sensor's field of view that nothing hides, whether a beam met them or not.
  std::vector<PlaceInView> in_view;
};

// One Husky-like robot that explores a world with an OS1-64, and what it could have known.
struct LabelledRun {
  std::string world;
  std::vector<GroundPlace> places;
  std::vector<LabelledScan> scans;
};

struct LabelledRunOptions {
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  double scan_period_s = 1.0;
  double max_range_m = 20.0;
  double place_spacing_m = 0.3;
  std::vector<world::Vehicle> vehicles = {world::husky()};
};

// The same options give the same bytes. The world stands still, poses are true.
LabelledRun explore_and_label(const world::World& world, const LabelledRunOptions& options);

}  // namespace warren
