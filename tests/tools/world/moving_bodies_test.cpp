// SPDX-License-Identifier: Apache-2.0
#include "tools/world/moving_bodies.hpp"

#include <doctest/doctest.h>

#include "tools/world/random.hpp"

using namespace warren::world;

namespace {

const Cylinder kPerson{{3.0, 0.0, 0.0}, 0.25, 1.75};

std::optional<float> cast_one(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return cast(std::array{kPerson}, Ray{from, (to - from).normalized()});
}

}  // namespace

TEST_CASE("a person is met at the side, from above and from below") {
  CHECK(*cast_one({0.0F, 0.0F, 1.0F}, {3.0F, 0.0F, 1.0F}) == doctest::Approx(2.75));
  CHECK(*cast_one({3.1F, 0.0F, 4.0F}, {3.1F, 0.0F, 0.0F}) == doctest::Approx(2.25));
  CHECK(*cast_one({3.0F, 0.1F, -1.0F}, {3.0F, 0.1F, 0.0F}) == doctest::Approx(1.0));
}

TEST_CASE("rays pass beside, above and away from a person") {
  CHECK_FALSE(cast_one({0.0F, 0.0F, 1.0F}, {3.0F, 0.3F, 1.0F}));
  CHECK_FALSE(cast_one({0.0F, 0.0F, 2.0F}, {3.0F, 0.0F, 1.9F}));
  CHECK_FALSE(cast_one({0.0F, 0.0F, 1.0F}, {-3.0F, 0.0F, 1.0F}));
  CHECK_FALSE(cast_one({3.3F, 0.0F, 4.0F}, {3.3F, 0.0F, 0.0F}));
}

TEST_CASE("a ray from within a body does not see it") {
  CHECK_FALSE(cast_one({3.0F, 0.1F, 1.0F}, {9.0F, 0.0F, 1.0F}));
}

TEST_CASE("every range lies on the surface of the cylinder, and nothing before it is inside") {
  Random random(4);
  const auto inside = [](const Eigen::Vector3d& p, double slack) {
    return (p - kPerson.foot).head<2>().norm() < kPerson.radius_m + slack && p.z() > -slack &&
           p.z() < kPerson.height_m + slack;
  };
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f from(static_cast<float>(random.uniform(0.0, 6.0)),
                               static_cast<float>(random.uniform(-3.0, 3.0)),
                               static_cast<float>(random.uniform(-1.0, 3.0)));
    const Eigen::Vector3f to(static_cast<float>(random.uniform(2.5, 3.5)),
                             static_cast<float>(random.uniform(-0.5, 0.5)),
                             static_cast<float>(random.uniform(-0.5, 2.5)));
    if (inside(from.cast<double>(), 0.01)) continue;
    const auto found = cast_one(from, to);
    const Eigen::Vector3d along = (to - from).normalized().cast<double>();
    const double until_m = found ? static_cast<double>(*found) : 20.0;
    for (int step = 0; 0.02 * step < until_m; ++step)
      CHECK_FALSE(inside(from.cast<double>() + 0.02 * step * along, -1e-3));
    if (!found) continue;
    ++hits;
    const Eigen::Vector3d hit = from.cast<double>() + until_m * along;
    CHECK(inside(hit, 1e-4));
    CHECK_FALSE(inside(hit, -1e-4));
  }
  CHECK(hits > 500);
}

TEST_CASE("bodies are where they have moved to, and not there before they appear") {
  MovingBodies bodies;
  bodies.add(
      {.foot = [](double time_s) { return Eigen::Vector3d(time_s, 0.0, 0.0); }, .appears_s = 2.0});
  CHECK(bodies.at(1.9).empty());
  REQUIRE(bodies.at(5.0).size() == 1);
  CHECK(bodies.at(5.0)[0].foot.x() == 5.0);
}

TEST_CASE("the nearer of two bodies is seen") {
  const std::array both{Cylinder{{5.0, 0.0, 0.0}, 0.5, 2.0}, Cylinder{{3.0, 0.0, 0.0}, 0.5, 2.0}};
  const Ray ray{Eigen::Vector3f(0.0F, 0.0F, 1.0F), Eigen::Vector3f::UnitX(), 2.6F};
  CHECK(*cast(both, ray) == doctest::Approx(2.5));
  CHECK_FALSE(cast(both, Ray{ray.origin, ray.direction, 2.4F}));
}
