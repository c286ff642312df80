// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/sensor_model.hpp"

#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

using warren::FixedSensorModel;
using warren::SensorModel;

namespace {

double log_odds(double p) { return std::log(p / (1.0 - p)); }

void check_close(const SensorModel& model) {
  const FixedSensorModel fixed(model);
  CHECK(fixed.hit / fixed.per_unit == doctest::Approx(log_odds(model.hit)).epsilon(2e-5));
  CHECK(fixed.miss / fixed.per_unit == doctest::Approx(log_odds(model.miss)).epsilon(2e-4));
  CHECK(fixed.minimum / fixed.per_unit == doctest::Approx(log_odds(model.minimum)).epsilon(2e-4));
  CHECK(fixed.maximum / fixed.per_unit == doctest::Approx(log_odds(model.maximum)).epsilon(2e-4));
}

}  // namespace

TEST_CASE("fixed point keeps all four log-odds of both shipped models") {
  check_close(SensorModel::octomap_default());
  check_close(SensorModel::field());
  check_close(SensorModel::ours());
}

TEST_CASE("the sign of any sum of hits and misses survives fixed point") {
  for (const SensorModel& model :
       {SensorModel::octomap_default(), SensorModel::field(), SensorModel::ours()}) {
    const FixedSensorModel fixed(model);
    for (int hits = 0; hits < 40; ++hits) {
      for (int misses = 0; misses < 200; ++misses) {
        const double exact = hits * log_odds(model.hit) + misses * log_odds(model.miss);
        const int steps = hits * fixed.hit + misses * fixed.miss;
        if (hits + misses > 0 && exact != 0.0) CHECK((steps >= 0) == (exact >= 0.0));
      }
    }
  }
}

TEST_CASE("a model is valid only inside its ranges") {
  CHECK(SensorModel::field().is_valid());
  CHECK(SensorModel::ours().is_valid());
  CHECK_FALSE(SensorModel{0.5, 0.4, 0.1, 0.9}.is_valid());
  CHECK_FALSE(SensorModel{0.7, 0.5, 0.1, 0.9}.is_valid());
  CHECK_FALSE(SensorModel{0.7, 0.4, 0.0, 0.9}.is_valid());
  CHECK_FALSE(SensorModel{0.7, 0.4, 0.1, 1.0}.is_valid());
  CHECK_FALSE(SensorModel{std::nan(""), 0.4, 0.1, 0.9}.is_valid());
}

TEST_CASE("the weakest valid miss still moves a voxel") {
  const FixedSensorModel fixed(SensorModel{0.501, 0.499999, 0.01, 0.99});
  CHECK(fixed.miss < 0);
  CHECK(fixed.hit > 0);
}
