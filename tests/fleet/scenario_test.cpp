// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/scenario.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include <doctest/doctest.h>

namespace warren::fleet_sim {
namespace {

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

TEST_CASE("whatever happens to a fleet, copies are exact, and all become equal when it heals") {
  const std::uint64_t first = number_from("WARREN_FLEET_FIRST", 1);
  const std::uint64_t seeds = number_from("WARREN_FLEET_SEEDS", 200);
  std::vector<double> healing;
  std::size_t not_silent = 0;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    const Outcome outcome = run_scenario(seed);
    healing.push_back(outcome.healing_s);
    std::string all;
    for (const auto& failure : outcome.failures) all += "\n  " + failure;
    CHECK_MESSAGE(outcome.failures.empty(), "seed ", seed, ": ", outcome.story, all);
    // Where every third packet is lost, links come and go even in peace, and ways with them.
    const std::uint64_t quiet = outcome.loss < 0.1 ? 0 : 4000;
    CHECK_MESSAGE(outcome.quiet_bytes <= quiet, "seed ", seed,
                  " is not quiet: ", outcome.quiet_bytes, " bytes; ", outcome.story);
    if (outcome.quiet_bytes > 0) ++not_silent;
  }
  std::sort(healing.begin(), healing.end());
  std::cout << "healing, s: median " << healing[healing.size() / 2] << ", p95 "
            << healing[healing.size() * 95 / 100] << ", most " << healing.back()
            << "; not silent afterwards: " << not_silent << " of " << seeds << "\n";
}

// How many of so many seeds notice.
std::size_t noticed(Planted planted, std::uint64_t seeds) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    found += run_scenario(seed, planted).failures.empty() ? 0U : 1U;
  }
  return found;
}

TEST_CASE("a planted fault is noticed") {
  struct Case {
    const char* name;
    Planted planted;
    std::uint64_t seeds;
  };
  for (const Case& fault : {Case{"a widened claim", Planted::kClaimWidened, 10},
                            Case{"a revision reused", Planted::kRevisionReused, 40},
                            Case{"a lost packet believed", Planted::kLostIsBelieved, 10},
                            Case{"a store that lacks a block", Planted::kStoreWithoutCodes, 40}}) {
    const std::size_t found = noticed(fault.planted, fault.seeds);
    std::cout << fault.name << ": noticed by " << found << " of " << fault.seeds << " seeds\n";
    CHECK_MESSAGE(found > 0, fault.name);
  }
}

}  // namespace
}  // namespace warren::fleet_sim
