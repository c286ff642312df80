// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "tests/sim/simulation.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

LinkConfig radio(double bit_s, Duration delay, double loss) {
  LinkConfig link;
  link.capacity = Capacity(bit_s);
  link.delay = delay;
  link.loss = loss;
  return link;
}

TEST_CASE("two nodes find each other and hand over a parcel") {
  Simulation::Config config;
  config.networks[0].link = radio(1e6, milliseconds(50), 0.0);
  Simulation simulation(config);
  simulation.start(0);
  simulation.start(1);
  REQUIRE(simulation.send_parcel(0, 1, ParcelClass::kMessage, 5000));
  const bool done = simulation.run_until(MeshTime(seconds(5)),
                                         [&] { return simulation.ledger().outstanding() == 0; });
  CHECK(done);
  MESSAGE("at ", std::chrono::duration<double>(simulation.now().time_since_epoch()).count());
  for (const auto& failure : simulation.ledger().failures()) FAIL_CHECK(failure);
}

TEST_CASE("telemetry larger than the first packets are arrives all the same") {
  for (const double bit_s : {50e3, 1e6}) {
    CAPTURE(bit_s);
    Simulation::Config config;
    config.networks[0].link = radio(bit_s, milliseconds(50), 0.0);
    Simulation simulation(config);
    simulation.start(0);
    simulation.start(1);
    simulation.set_telemetry(0, 7, 900);
    const bool arrived = simulation.run_until(
        MeshTime(seconds(5)), [&] { return !simulation.node(1).telemetry_latency.empty(); });
    CHECK(arrived);
    for (const auto& failure : simulation.ledger().failures()) FAIL_CHECK(failure);
  }
}

}  // namespace
}  // namespace warren::mesh::sim
