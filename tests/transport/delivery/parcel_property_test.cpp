// SPDX-License-Identifier: Apache-2.0
// Parcels through a bad channel and through restarts of both sides at any time.
#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/delivery/toy_channel.hpp"

using namespace warren;
using namespace warren::mesh;
using namespace warren::mesh::test;

namespace {

DeliveryConfig small_config() {
  DeliveryConfig config;
  config.parcel.ask_after = std::chrono::milliseconds(200);
  return config;
}

std::size_t some_size(Random& random) {
  switch (below(random, 4)) {
    case 0:
      return 8 + below(random, 100);
    case 1:
      return 1000 + below(random, 5000);
    case 2:
      return 20'000 + below(random, 60'000);
    default:
      return 8 + below(random, 2000);
  }
}

ParcelClass some_class(Random& random) {
  return chance(random, 0.3) ? ParcelClass::kControl : ParcelClass::kMessage;
}

void send_some(ToyPair& pair, std::size_t index, std::uint64_t& next_id) {
  const std::size_t size = some_size(pair.random());
  pair.node(index).send_parcel(next_id++, size, some_class(pair.random()));
}

// Everything promised is stored once, and nothing twice, and nothing is held any more.
void check_all_stored(ToyPair& pair, std::size_t from) {
  const ToyNode& sender = pair.node(from);
  const ToyNode& receiver = pair.node(1 - from);
  for (const auto& [id, times] : receiver.stored) {
    RC_ASSERT(times == 1U);
    RC_ASSERT(sender.sent.contains(id));
  }
  for (const std::uint64_t id : sender.promised) RC_ASSERT(receiver.stored.contains(id));
}

bool settle(ToyPair& pair, int steps) {
  pair.faults = {};
  for (int step = 0; step < steps; ++step) {
    pair.step();
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).store_some(1.0);
    if (pair.node(0).idle() && pair.node(1).idle()) return true;
  }
  return false;
}

struct Scenario {
  double loss = 0.0;
  double restart_share = 0.0;  // of the steps
  double save_share = 0.0;     // besides the savings when something was stored
  bool save_at_restart = false;
};

void run(ToyPair& pair, const Scenario& scenario, int steps) {
  std::uint64_t next_id = 1;
  pair.faults.loss = scenario.loss;
  pair.faults.duplicate = 0.1;
  pair.room = 200 + below(pair.random(), 1100);
  for (int step = 0; step < steps; ++step) {
    const std::size_t index = below(pair.random(), 2);
    if (chance(pair.random(), 0.05)) send_some(pair, index, next_id);
    if (chance(pair.random(), 0.01)) pair.faults.cut = !pair.faults.cut;
    if (chance(pair.random(), scenario.save_share)) pair.node(index).save();
    if (chance(pair.random(), scenario.restart_share)) {
      if (scenario.save_at_restart) pair.node(index).save();
      pair.restart(index);
    }
    pair.step();
    pair.node(index).store_some(0.2);
    for (std::size_t i = 0; i < 2; ++i) {
      RC_ASSERT(pair.node(i).inbox().unfinished_bytes() <=
                pair.node(i).config().parcel.received_bytes_max);
      RC_ASSERT(pair.node(i).received_budget().used() == pair.node(i).inbox().unfinished_bytes());
    }
  }
}

}  // namespace

TEST_CASE("parcels come once and all of them, through loss, duplication and overtaking") {
  CHECK(rc::check("parcels come once and all of them", [](std::uint64_t seed) {
    ToyPair pair(small_config(), seed);
    Scenario scenario;
    scenario.loss = static_cast<double>(seed % 5) / 10.0;
    run(pair, scenario, 400);
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).save();
    RC_ASSERT(settle(pair, 4000));
    check_all_stored(pair, 0);
    check_all_stored(pair, 1);
    for (std::size_t i = 0; i < 2; ++i)
      RC_ASSERT(pair.node(i).delivered.size() == pair.node(i).sent.size());
  }));
}

TEST_CASE("restarts of either side that saved at their end lose and repeat no parcel") {
  CHECK(rc::check("restarts that saved at their end", [](std::uint64_t seed) {
    ToyPair pair(small_config(), seed);
    run(pair, {0.2, 0.02, 0.0, true}, 600);
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).save();
    RC_ASSERT(settle(pair, 4000));
    check_all_stored(pair, 0);
    check_all_stored(pair, 1);
  }));
}

TEST_CASE("crashes lose no parcel that was saved, and repeat none") {
  CHECK(rc::check("crashes lose no saved parcel", [](std::uint64_t seed) {
    ToyPair pair(small_config(), seed);
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).save();
    run(pair, {0.2, 0.02, 0.05, false}, 600);
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).save();
    RC_ASSERT(settle(pair, 4000));
    check_all_stored(pair, 0);
    check_all_stored(pair, 1);
  }));
}

TEST_CASE("a receiver with less room than its sender thinks gets all parcels nevertheless") {
  CHECK(rc::check("a receiver with less room", [](std::uint64_t seed) {
    DeliveryConfig narrow = small_config();
    narrow.parcel.received_bytes_max = ParcelBudget::charge(ParcelFrame::kBytesMax) + 90'000;
    narrow.parcel.unfinished_max = 5;
    ToyPair pair(small_config(), narrow, seed);
    run(pair, {0.1, 0.01, 0.0, true}, 400);
    for (std::size_t i = 0; i < 2; ++i) pair.node(i).save();
    RC_ASSERT(settle(pair, 20'000));
    check_all_stored(pair, 0);
  }));
}
