// SPDX-License-Identifier: Apache-2.0
#include "tools/world/radio.hpp"

#include <algorithm>
#include <cmath>

namespace warren::world {
namespace {

double watts(double dbm) { return 0.001 * std::pow(10.0, dbm / 10.0); }

}  // namespace

std::optional<double> path_loss_db(const RadioModel& model, const RadioLink& link) {
  if (link.distance_m > model.max_range_m || !(link.cost <= model.max_cost)) return std::nullopt;
  const double exponent = model.exponent + model.exponent_per_cost * link.cost;
  const double distance_m =
      model.distance_scale * (link.distance_m + link.hops * model.distance_per_hop_m);
  // Nearer than a metre the logarithm would be a gain.
  return model.loss_at_1_m_db + 10.0 * exponent * std::log10(std::max(1.0, distance_m));
}

double bit_error_rate(const RadioModel& model, double received_dbm) {
  return std::erfc(std::sqrt(watts(received_dbm) / watts(model.noise_floor_dbm)));
}

double packet_loss(const RadioModel& model, double received_dbm, std::size_t bytes) {
  // 1 - (1 - BER)^bytes, without losing what is small.
  return -std::expm1(static_cast<double>(bytes) * std::log1p(-bit_error_rate(model, received_dbm)));
}

RadioState radio_state(const RadioModel& model, const RadioLink& link, std::size_t bytes,
                       Random& fading) {
  const double fade_db = std::sqrt(model.fading_variance_db2) * fading.normal();
  const auto loss_db = path_loss_db(model, link);
  if (!loss_db) return {};
  return {.loss = packet_loss(model, model.tx_power_dbm - *loss_db + fade_db, bytes),
          .rate_bit_s = model.rate_bit_s};
}

}  // namespace warren::world
