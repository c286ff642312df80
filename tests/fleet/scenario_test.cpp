// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/scenario.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/support/under_sanitizer.hpp"

namespace warren::fleet_sim {
namespace {

// 1000 in all, in parts that ctest runs side by side. WARREN_FLEET_SEED=N runs that one alone.
constexpr std::uint64_t kSeedsPerPart = test::kUnderSanitizer ? 15 : 250;

Outcome run(std::uint64_t seed) {
  Outcome outcome = run_scenario(seed);
  std::string all;
  for (const auto& failure : outcome.failures) all += "\n  " + failure;
  CHECK_MESSAGE(outcome.failures.empty(), "WARREN_FLEET_SEED=", seed, ": ", outcome.story, all);
  // Where packets are lost, links come and go even in peace, and ways with them: at times a word is
  // said about that, and where every third packet is lost, many; longer ones where copies are in
  // pieces.
  const std::uint64_t many = outcome.near ? 8000 : 4000;
  const std::uint64_t quiet = outcome.loss < 0.05 ? 0 : outcome.loss < 0.1 ? 100 : many;
  CHECK_MESSAGE(outcome.quiet_bytes <= quiet, "WARREN_FLEET_SEED=", seed,
                " is not quiet: ", outcome.quiet_bytes, " bytes; ", outcome.story);
  return outcome;
}

void run_part(std::uint64_t part) {
  if (const char* seed = std::getenv("WARREN_FLEET_SEED")) {
    if (part == 0) MESSAGE("healed in ", run(std::strtoull(seed, nullptr, 10)).healing_s, " s");
    return;
  }
  std::vector<double> healing;
  std::size_t not_silent = 0;
  Fleet::Packets packets;
  for (std::uint64_t i = 1; i <= kSeedsPerPart; ++i) {
    const Outcome outcome = run(part * kSeedsPerPart + i);
    healing.push_back(outcome.healing_s);
    if (outcome.quiet_bytes > 0) ++not_silent;
    packets.applied += outcome.packets.applied;
    packets.duplicate += outcome.packets.duplicate;
  }
  std::sort(healing.begin(), healing.end());
  // What comes twice was sent again as its acknowledgement was lost or late, or by two in turn.
  CHECK(packets.duplicate < packets.applied / 5);
  MESSAGE("healing, s: median ", healing[healing.size() / 2], ", most ", healing.back(),
          "; not silent afterwards: ", not_silent, " of ", kSeedsPerPart,
          "; packets for copies: ", packets.applied, ", twice: ", packets.duplicate);
}

TEST_CASE("whatever happens to a fleet, it heals, part 1") { run_part(0); }
TEST_CASE("whatever happens to a fleet, it heals, part 2") { run_part(1); }
TEST_CASE("whatever happens to a fleet, it heals, part 3") { run_part(2); }
TEST_CASE("whatever happens to a fleet, it heals, part 4") { run_part(3); }

// How many of so many seeds notice.
std::size_t noticed(Planted planted, std::uint64_t seeds) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    found += run_scenario(seed, planted).failures.empty() ? 0U : 1U;
  }
  return found;
}

TEST_CASE("a planted fault is noticed") {
  if (test::kUnderSanitizer) return;  // this proves the invariants, and nothing about memory
  struct Case {
    const char* name;
    Planted planted;
    std::size_t least;  // about half of what it was when this was written
  };
  constexpr std::uint64_t kSeeds = 100;
  for (const Case& fault : {Case{"a widened claim", Planted::kClaimWidened, 18},
                            Case{"a revision reused", Planted::kRevisionReused, 4},
                            Case{"a merge into the own layer", Planted::kMergedIntoSelf, 40},
                            Case{"a lost packet believed", Planted::kLostIsBelieved, 16},
                            Case{"a store that lacks a block", Planted::kStoreWithoutCodes, 9}}) {
    const std::size_t found = noticed(fault.planted, kSeeds);
    MESSAGE(std::string(fault.name), ": noticed by ", found, " of ", kSeeds, " seeds");
    CHECK_MESSAGE(found >= fault.least, std::string(fault.name));
  }
}
}  // namespace
}  // namespace warren::fleet_sim
