// SPDX-License-Identifier: Apache-2.0
#include "tools/world/noise.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "tools/world/random.hpp"

namespace warren::world {

TEST_CASE("noise is the same for the same place and seed, another for another seed") {
  const Eigen::Vector3d place(12.3, -4.56, 7.89);
  CHECK(gradient_noise(place, 5) == gradient_noise(place, 5));
  CHECK(gradient_noise(place, 5) != gradient_noise(place, 6));
  // Golden: a change here changes every world.
  CHECK(gradient_noise({0.5, 0.25, 0.75}, 1) == -0x1.afe4p-4);
  CHECK(fractal_noise({-3.2, 8.1, 0.6}, 3, 42) == -0x1.190fe3c7cb6cep-1);
}

TEST_CASE("noise is zero on the lattice, bounded, and about zero on the whole") {
  Random random(1);
  double sum = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d place(random.uniform(-90, 90), random.uniform(-90, 90),
                                random.uniform(-90, 90));
    CHECK(std::abs(gradient_noise(place.array().round(), 7)) < 1e-12);
    const double value = gradient_noise(place, 7);
    sum += value;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  CHECK(std::abs(sum / 20000) < 0.02);
  CHECK(lowest > -1.2);
  CHECK(lowest < -0.5);
  CHECK(highest < 1.2);
  CHECK(highest > 0.5);
}

TEST_CASE("noise has no steps, least of all where its cells meet") {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3d place(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    if (i % 2 == 0) place.x() = std::round(place.x());
    const Eigen::Vector3d nudge(1e-5, -1e-5, 1e-5);
    CHECK(std::abs(gradient_noise(place + nudge, 3) - gradient_noise(place - nudge, 3)) < 3e-4);
  }
}

}  // namespace warren::world
