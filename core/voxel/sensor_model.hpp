// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace warren {

inline double probability_of(float log_odds) {
  return 1.0 / (1.0 + std::exp(-static_cast<double>(log_odds)));
}

// Probabilities of the binary Bayes filter (paper Eq. 1-2): of occupancy given a hit and a pass,
// and the two clamps. Valid: 0 < minimum, miss < 0.5 < hit, maximum < 1.
struct SensorModel {
  double hit = 0.7;
  double miss = 0.4;
  double minimum = 0.1192;
  double maximum = 0.971;

  static SensorModel octomap_default() { return {}; }
  // Parameters flown in the field: sticky, keeps thin things.
  static SensorModel field() { return {0.95, 0.48, 0.12, 0.97}; }

  // The daemon's default, chosen by the tables of `warren-bench map-quality` (docs/BENCHMARKS.md):
  // nearly as safe as the field's, and who has passed by is gone after two thirds of the time.
  static SensorModel ours() { return {0.97, 0.47, 0.12, 0.97}; }

  bool is_valid() const;
  friend bool operator==(const SensorModel&, const SensorModel&) = default;
};

// The same filter in 16-bit fixed point. `per_unit` (steps per unit of log-odds) is searched so
// that all four numbers fall as close to whole steps as 16 bits allow: sums then keep the sign
// that the exact sums have, on every CPU.
struct FixedSensorModel {
  explicit FixedSensorModel(const SensorModel& model);

  std::int16_t hit;
  std::int16_t miss;  // negative
  std::int16_t minimum;
  std::int16_t maximum;
  double per_unit;

  float log_odds(std::int16_t steps) const {
    return static_cast<float>(static_cast<double>(steps) / per_unit);
  }
};

}  // namespace warren
