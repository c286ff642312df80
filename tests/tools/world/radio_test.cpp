// SPDX-License-Identifier: Apache-2.0
#include "tools/world/radio.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace warren::world;

TEST_CASE("path loss is as computed by hand from the simulator's parameters") {
  const RadioModel model;
  // 40 + 10 * 1.5 * log10(0.55 * 100) = 40 + 15 * 1.740363
  CHECK(*path_loss_db(model, {.distance_m = 100.0}) == doctest::Approx(66.10544));
  // 40 + 10 * 2.5 * log10(0.55 * (200 + 3 * 2)) = 40 + 25 * 2.054230
  CHECK(*path_loss_db(model, {.distance_m = 200.0, .cost = 5.0, .hops = 3}) ==
        doctest::Approx(91.35575));
  CHECK(*path_loss_db(model, {.distance_m = 0.5}) == 40.0);
}

TEST_CASE("beyond the range, or too much rock, there is no link") {
  const RadioModel model;
  CHECK(path_loss_db(model, {.distance_m = 499.0}));
  CHECK_FALSE(path_loss_db(model, {.distance_m = 501.0}));
  CHECK(path_loss_db(model, {.distance_m = 50.0, .cost = 10.0}));
  CHECK_FALSE(path_loss_db(model, {.distance_m = 50.0, .cost = 11.0}));
  CHECK_FALSE(path_loss_db(model, {.distance_m = 50.0, .cost = INFINITY}));
}

TEST_CASE("bit errors and packet loss are as computed by hand") {
  const RadioModel model;
  // At the noise floor the ratio is 1: erfc(1). 6 dB above it is 3.981072: erfc(1.995263).
  CHECK(bit_error_rate(model, -90.0) == doctest::Approx(0.157299));
  CHECK(bit_error_rate(model, -84.0) == doctest::Approx(0.00477774).epsilon(1e-4));
  // 1 - (1 - 0.00477774)^100
  CHECK(packet_loss(model, -84.0, 100) == doctest::Approx(0.380567).epsilon(1e-4));
  CHECK(packet_loss(model, -60.0, 1400) < 1e-12);
  CHECK(packet_loss(model, -100.0, 1400) == doctest::Approx(1.0));
  CHECK(packet_loss(model, -1000.0, 1) == doctest::Approx(1.0));
}

TEST_CASE("loss grows with the distance, the rock and the packet") {
  RadioModel model;
  model.fading_variance_db2 = 0.0;
  Random unused(1);
  double last = 0.0;
  for (int step = 1; step <= 50; ++step) {
    const double distance_m = 10.0 * step;
    const RadioLink link{.distance_m = distance_m, .cost = 8.0};
    const double loss = radio_state(model, link, 1200, unused).loss;
    CHECK(loss >= last);
    CHECK(radio_state(model, link, 100, unused).loss <= loss);
    last = loss;
  }
  CHECK(last > 0.99);
}

TEST_CASE("fading spreads the power by the root of the variance") {
  RadioModel model;
  const RadioLink link{.distance_m = 340.0, .cost = 5.0};
  // Loss rises monotonically as power falls, so its median is that of the mean power.
  const double middle = packet_loss(model, model.tx_power_dbm - *path_loss_db(model, link), 100);
  const double weaker =
      packet_loss(model, model.tx_power_dbm - *path_loss_db(model, link) - std::sqrt(10.0), 100);
  Random fading(3);
  int above_middle = 0;
  int above_weaker = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const double loss = radio_state(model, link, 100, fading).loss;
    if (loss > middle) ++above_middle;
    if (loss > weaker) ++above_weaker;
  }
  CHECK(above_middle == doctest::Approx(0.5 * kDraws).epsilon(0.03));
  CHECK(above_weaker == doctest::Approx(0.15866 * kDraws).epsilon(0.06));
}

TEST_CASE("without a link nothing arrives and no rate is given") {
  Random fading(1);
  const RadioState state = radio_state({}, {.distance_m = 900.0}, 100, fading);
  CHECK(state.loss == 1.0);
  CHECK(state.rate_bit_s == 0.0);
  CHECK(radio_state({}, {.distance_m = 9.0}, 100, fading).rate_bit_s == 1e6);
}
