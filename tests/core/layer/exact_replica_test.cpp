// SPDX-License-Identifier: Apache-2.0
// The rules of replication, checked on random runs of a fleet: see FleetModel.
#include <algorithm>

#include <doctest/doctest.h>

#include "tests/core/layer/fleet_model.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;
using test::Fault;
using test::FleetModel;
using test::FleetPlan;

namespace {

FleetPlan plan_of(std::uint64_t seed, Fault fault = Fault::kNone) {
  FleetPlan plan{seed, fault};
  plan.noise = seed % 20 == 0;
  return plan;
}

// Of the first seeds, how many the checker calls broken.
std::uint64_t noticed(Fault fault, std::uint64_t seeds) {
  std::uint64_t broken = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    FleetModel fleet(plan_of(seed, fault));
    if (!fleet.run()) ++broken;
  }
  return broken;
}

}  // namespace

TEST_CASE("every block of every replica is the origin's at the revision held, whatever happens") {
  constexpr std::uint64_t kSeeds = test::kUnderSanitizer ? 2000 : 20000;
  std::size_t rested = 0;
  std::array<std::uint64_t, kApplyResults> results{};
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    CAPTURE(seed);
    FleetModel fleet(plan_of(seed));
    REQUIRE(fleet.run());
    REQUIRE(fleet.catch_up());
    for (std::size_t i = 0; i < kApplyResults; ++i) {
      results[i] += fleet.count(static_cast<ApplyResult>(i));
    }
    rested += fleet.regions_rested();
  }
  for (const ApplyResult met : {ApplyResult::kApplied, ApplyResult::kDuplicate, ApplyResult::kGap,
                                ApplyResult::kOtherLayer}) {
    CHECK(results[static_cast<std::size_t>(met)] > kSeeds / 2);
  }
  CHECK(results[static_cast<std::size_t>(ApplyResult::kMalformed)] == 0);
  CHECK(rested > kSeeds / 10);
}

TEST_CASE("replicas cut into as many intervals as there may be still catch up") {
  std::uint64_t refused = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    FleetPlan plan = plan_of(seed);
    plan.steps = 4000;
    plan.keys = 3000;
    plan.blocks_max = 60;
    plan.narrow = true;
    FleetModel fleet(plan);
    REQUIRE(fleet.run());
    REQUIRE(fleet.intervals_seen_max() <= Holdings::kIntervalsMax);
    REQUIRE(fleet.catch_up());
    refused += fleet.count(ApplyResult::kTooManyIntervals);
  }
  CHECK(refused > 0);
}

TEST_CASE("the checker notices every planted fault") {
  constexpr std::uint64_t kSeeds = 200;
  CHECK(noticed(Fault::kNone, kSeeds) == 0);
  for (const Fault fault :
       {Fault::kClaimsWhatIsNotHeld, Fault::kMissesAChange, Fault::kCodesNewerThanClaimed,
        Fault::kLowersHeld, Fault::kReusesRevision, Fault::kReusesLayerId}) {
    CAPTURE(static_cast<int>(fault));
    CHECK(noticed(fault, kSeeds) > kSeeds / 50);
  }
}
