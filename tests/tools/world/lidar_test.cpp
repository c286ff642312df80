// SPDX-License-Identifier: Apache-2.0
#include "tools/world/lidar.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include <doctest/doctest.h>

#include "tests/tools/world/hand_made.hpp"

using namespace warren;
using namespace warren::world;

namespace {

const Eigen::Vector3f kHalf(8.0F, 5.0F, 2.0F);

struct RoomWithLidar {
  TriangleMesh mesh = test::room(kHalf);
  Caster caster{mesh};
  MovingBodies bodies;
  LidarModel model = *lidar_of("os1-64");

  Sweep turn(const SensorMotion& motion, Deskew deskew, std::uint64_t seed = 1) const {
    Random random(seed);
    return sweep({caster, bodies}, model, motion, 1.0, deskew, random);
  }
};

LidarModel without_faults(LidarModel model) {
  model.range_noise_m = 0.0F;
  model.dropout = 0.0;
  return model;
}

Eigen::Isometry3d still(double) { return Eigen::Isometry3d::Identity(); }

// Fast and turning: 2 m/s and 1 rad/s.
Eigen::Isometry3d driving(double time_s) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(time_s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(2.0 * time_s - 1.0, 0.3 * time_s, 0.1);
  return T;
}

float distance_to_walls(const Eigen::Vector3f& p) {
  float nearest_m = INFINITY;
  for (int axis = 0; axis < 3; ++axis)
    nearest_m = std::min(nearest_m, std::abs(kHalf[axis] - std::abs(p[axis])));
  return nearest_m;
}

float worst_distance_to_walls(const Sweep& turn) {
  float worst_m = 0.0F;
  for (const Point3f& p : turn.points_sensor)
    worst_m = std::max(worst_m, distance_to_walls(turn.T_world_sensor.cast<float>() *
                                                  Eigen::Vector3f(p.x, p.y, p.z)));
  return worst_m;
}

float exact_range(const Eigen::Vector3f& along) {
  float range_m = INFINITY;
  for (int axis = 0; axis < 3; ++axis)
    range_m = std::min(range_m, kHalf[axis] / std::abs(along[axis]));
  return range_m;
}

}  // namespace

TEST_CASE("the lidars have the beams of their data sheets") {
  for (const auto& [name, beams, half_field_deg] :
       {std::tuple{"os1-64", 64U, 22.5}, std::tuple{"os0-128", 128U, 45.0},
        std::tuple{"os1-128", 128U, 22.5}}) {
    const LidarModel model = lidar_of(name).value();
    const double half_rad = half_field_deg * std::numbers::pi / 180.0;
    CHECK(model.name == name);
    CHECK(model.elevations_rad.size() == beams);
    CHECK(static_cast<double>(model.elevations_rad.front()) == doctest::Approx(half_rad));
    CHECK(static_cast<double>(model.elevations_rad.back()) == doctest::Approx(-half_rad));
    CHECK(std::is_sorted(model.elevations_rad.rbegin(), model.elevations_rad.rend()));
  }
  CHECK(lidar_names().size() == 3);
  CHECK_FALSE(lidar_of("sonar"));
}

TEST_CASE("a sensor at rest measures the box that it stands in") {
  RoomWithLidar room;
  room.model = without_faults(room.model);
  const Sweep turn = room.turn(still, Deskew::kYes);
  REQUIRE(turn.points_sensor.size() == 64 * 1024);
  for (std::size_t i = 0; i < turn.points_sensor.size(); ++i) {
    const Point3f& p = turn.points_sensor[i];
    const Eigen::Vector3f point(p.x, p.y, p.z);
    const std::size_t column = i / 64;
    const auto azimuth = -2.0 * std::numbers::pi * static_cast<double>(column + 1) / 1024.0;
    const auto elevation = static_cast<double>(room.model.elevations_rad[i % 64]);
    const Eigen::Vector3d along(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const float range_m = exact_range(along.cast<float>());
    REQUIRE((point - range_m * along.cast<float>()).norm() < 2e-4F);
  }
}

TEST_CASE("de-skewed points of a moving sensor lie on the walls") {
  RoomWithLidar room;
  room.model = without_faults(room.model);
  CHECK(worst_distance_to_walls(room.turn(driving, Deskew::kYes)) < 2e-4F);
}

TEST_CASE("raw points of a moving sensor do not") {
  RoomWithLidar room;
  room.model = without_faults(room.model);
  const Sweep raw = room.turn(driving, Deskew::kNo);
  CHECK(worst_distance_to_walls(raw) > 0.15F);
  // But each does from where its own column was measured.
  for (std::size_t i = 0; i < raw.points_sensor.size(); ++i) {
    const std::size_t columns_left = 1023 - i / 64;
    const double time_s = 1.0 - 0.1 / 1024.0 * static_cast<double>(columns_left);
    const Point3f& p = raw.points_sensor[i];
    REQUIRE(distance_to_walls(driving(time_s).cast<float>() * Eigen::Vector3f(p.x, p.y, p.z)) <
            2e-4F);
  }
}

TEST_CASE("noise and dropouts are as large as the model says") {
  RoomWithLidar room;
  room.model.range_noise_m = 0.02F;
  room.model.dropout = 0.05;
  const Sweep turn = room.turn(still, Deskew::kYes);
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const Point3f& p : turn.points_sensor) {
    if (!is_finite(p)) continue;
    const Eigen::Vector3f point(p.x, p.y, p.z);
    const double error = static_cast<double>(point.norm() - exact_range(point.normalized()));
    sum += error;
    squares += error * error;
    count += 1.0;
  }
  CHECK(1.0 - count / (64.0 * 1024.0) == doctest::Approx(0.05).epsilon(0.06));
  CHECK(std::abs(sum / count) < 0.0004);
  CHECK(std::sqrt(squares / count) == doctest::Approx(0.02).epsilon(0.02));
}

TEST_CASE("what is too near or too far gives no point") {
  RoomWithLidar room;
  room.model = without_faults(room.model);
  room.model.min_range_m = 5.5F;
  room.model.max_range_m = 7.0F;
  std::size_t absent = 0;
  const Sweep turn = room.turn(still, Deskew::kYes);
  for (const Point3f& p : turn.points_sensor) {
    const float range_m = Eigen::Vector3f(p.x, p.y, p.z).norm();
    if (is_finite(p)) CHECK((range_m > 5.499F && range_m < 7.001F));
    if (!is_finite(p)) ++absent;
  }
  CHECK(absent > 10000);
  CHECK(absent < 60000);
}

TEST_CASE("a person hides the wall behind") {
  RoomWithLidar room;
  room.model = without_faults(room.model);
  room.bodies.add({.foot = [](double) { return Eigen::Vector3d(3.0, 0.0, -1.0); }});
  const Sweep turn = room.turn(still, Deskew::kYes);
  std::size_t on_person = 0;
  for (const Point3f& p : turn.points_sensor) {
    const double from_axis_m = std::hypot(static_cast<double>(p.x) - 3.0, static_cast<double>(p.y));
    if (std::abs(from_axis_m - 0.25) < 1e-3) ++on_person;
    CHECK(from_axis_m > 0.249);
  }
  CHECK(on_person > 500);
}

TEST_CASE("the same seed gives the same bytes, another seed others") {
  const RoomWithLidar room;
  const auto same = [](const Sweep& a, const Sweep& b) {
    return std::memcmp(a.points_sensor.data(), b.points_sensor.data(),
                       a.points_sensor.size() * sizeof(Point3f)) == 0;
  };
  const Sweep once = room.turn(driving, Deskew::kYes, 5);
  CHECK(same(once, room.turn(driving, Deskew::kYes, 5)));
  CHECK_FALSE(same(once, room.turn(driving, Deskew::kYes, 6)));
}
