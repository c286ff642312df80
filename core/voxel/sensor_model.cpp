// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace warren {
namespace {

double log_odds_of(double probability) { return std::log(probability / (1.0 - probability)); }

// Largest distance of the scaled numbers from whole steps, relative to the scale. Hit and miss are
// added again and again, the clamps only once: an error in those is ten times as bad.
double worst_rounding(const std::array<double, 4>& log_odds, double per_unit) {
  constexpr std::array<double, 4> kWeight = {10.0, 10.0, 1.0, 1.0};
  double worst = 0.0;
  for (std::size_t i = 0; i < log_odds.size(); ++i) {
    const double steps = log_odds[i] * per_unit;
    worst = std::max(worst, kWeight[i] * std::abs(steps - std::round(steps)) / per_unit);
  }
  return worst;
}

double best_steps_per_unit(const std::array<double, 4>& log_odds) {
  double largest = 0.0;
  for (const double value : log_odds) largest = std::max(largest, std::abs(value));
  // A sum overshoots a clamp by one step of hit or miss before it is cut: half the range is ours.
  const double ceiling = 16000.0 / largest;
  double best = ceiling;
  double least = worst_rounding(log_odds, best);
  constexpr int kCandidates = 60000;
  for (int i = 1; i < kCandidates; ++i) {
    const double candidate = ceiling * (1.0 - 0.75 * i / kCandidates);
    const double rounding = worst_rounding(log_odds, candidate);
    if (rounding < least) {
      least = rounding;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

bool SensorModel::is_valid() const {
  return minimum > 0.0 && minimum < 0.5 && miss > 0.0 && miss < 0.5 && hit > 0.5 && hit < 1.0 &&
         maximum > 0.5 && maximum < 1.0;
}

FixedSensorModel::FixedSensorModel(const SensorModel& model) {
  const std::array<double, 4> log_odds = {log_odds_of(model.hit), log_odds_of(model.miss),
                                          log_odds_of(model.minimum), log_odds_of(model.maximum)};
  per_unit = best_steps_per_unit(log_odds);
  const auto steps = [this](double value) {
    return static_cast<std::int16_t>(std::lround(value * per_unit));
  };
  // However weak, a hit and a miss move a voxel.
  hit = std::max<std::int16_t>(steps(log_odds[0]), 1);
  miss = std::min<std::int16_t>(steps(log_odds[1]), -1);
  minimum = steps(log_odds[2]);
  maximum = steps(log_odds[3]);
}

}  // namespace warren
