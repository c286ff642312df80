// SPDX-License-Identifier: Apache-2.0
// Table 1 of the paper: what noise on a plane does to the two terms of the cost.
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "core/terrain/terrain_judge.hpp"

using namespace warren;

namespace {

struct Noise {
  double xy_m = 0.0;  // standard deviation, normal
  double z_m = 0.0;   // width, uniform: with that law the printed C and D come near
};

struct Terms {
  double slope = 0.0;
  double curvature = 0.0;
};

// Our own, so that golden values do not depend on a standard library.
class NoiseSource {
 public:
  double uniform() {  // SplitMix64
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ z >> 27) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_ = 1;
};

Terms mean_terms(const Noise& noise) {
  NoiseSource source;
  std::vector<Point3f> points;
  for (int i = 0; i <= 200; ++i) {
    for (int j = 0; j <= 200; ++j) {
      points.push_back({static_cast<float>(0.05 * i + noise.xy_m * source.normal()),
                        static_cast<float>(0.05 * j + noise.xy_m * source.normal()),
                        static_cast<float>(noise.z_m * (source.uniform() - 0.5))});
    }
  }
  TerrainJudge judge(TerrainConfig::paper());
  const auto judged = judge.judge({points, {}});
  const PlaneFits& planes = judge.planes();
  Terms sum;
  double count = 0.0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (!judged[i].has_cost()) continue;
    const double tilt = 1.0 - std::abs(static_cast<double>(planes.normal_z[i]));
    sum.slope += 20.0 * tilt * tilt * tilt;
    sum.curvature += 2.0 * static_cast<double>(planes.curvature[i]);
    count += 1.0;
  }
  CHECK(count > 0.9 * static_cast<double>(judged.size()));
  return {sum.slope / count, sum.curvature / count};
}

}  // namespace

TEST_CASE("Table 1: noise along the plane costs nothing, across it more the wider it is") {
  const Terms a = mean_terms({0.0, 0.0});
  const Terms b = mean_terms({1.0, 0.0});
  const Terms c = mean_terms({1.0, 0.10});
  const Terms d = mean_terms({1.0, 0.5});
  for (const Terms& printed_as_zero : {a, b}) {
    CHECK(printed_as_zero.slope < 1e-9);
    CHECK(printed_as_zero.curvature < 1e-6);
  }
  CHECK(c.slope < d.slope);
  CHECK(c.curvature > 0.01);
  CHECK(c.curvature < d.curvature);
  // Ours, by the law above; printed are 0 and 0.097, 2.254 and 0.364.
  CHECK(c.slope == doctest::Approx(2.291e-5).epsilon(0.01));
  CHECK(c.curvature == doctest::Approx(0.09444).epsilon(0.01));
  CHECK(d.slope == doctest::Approx(2.063).epsilon(0.01));
  CHECK(d.curvature == doctest::Approx(0.3710).epsilon(0.01));
}
