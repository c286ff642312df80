// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <doctest/doctest.h>

#include "tests/daemon/store/fault_vfs.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;
using namespace warren::test;

namespace {

constexpr std::uint32_t kSeeds = kUnderSanitizer ? 40 : 200;
constexpr int kCutsPerSeed = 4;

struct Life {
  bool began = false;
  std::uint64_t acknowledged = 0;  // steps
};

// Goes on until the disk refuses; knows in the end which steps it was told are stored.
Life live(const StoreConfig& config, std::uint32_t seed, std::uint64_t from_step) {
  auto opened = Store::open(config);
  Life life{opened.has_value(), from_step};
  if (!opened) return life;
  StoreScenario scenario = StoreScenario::after(seed, from_step);
  for (;;) {
    const StoreBatch batch = scenario.step();
    const StoreBatch* const one = &batch;
    const auto report = opened->store.commit({&one, 1});
    if (!report || report->results[0] != BatchResult::kStored) return life;
    life.acknowledged = scenario.steps();
  }
}

}  // namespace

TEST_CASE("a power cut at any instant loses nothing that was acknowledged") {
  std::uint64_t cuts_between = 0;  // that fell into a transaction which survived nevertheless
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    CAPTURE(seed);
    const TemporaryDirectory directory;
    FaultVfs disk(seed);
    const StoreConfig config = small_config(directory / "store.db", disk.name());
    std::mt19937 random(seed);
    std::uint64_t steps = 0;
    for (int cut = 0; cut < kCutsPerSeed; ++cut) {
      CAPTURE(cut);
      disk.power_off_after(1 + random() % 250);
      const Life life = live(config, seed, steps);
      disk.power_on();

      auto [store, report] = opened(config);
      CHECK_FALSE(report.moved_aside);
      CHECK_FALSE(report.rolled_back);
      const std::uint64_t found = steps_in(store);
      CHECK(found >= life.acknowledged);
      CHECK(found <= life.acknowledged + 1);
      CHECK(StoreScenario::after(seed, found).difference(store) == "");
      cuts_between += found > life.acknowledged ? 1 : 0;
      steps = found;
    }
  }
  CHECK(cuts_between > 0);
}

TEST_CASE("a power cut while a store is being opened leaves one that can be opened") {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    const TemporaryDirectory directory;
    FaultVfs disk(seed);
    const StoreConfig config = small_config(directory / "store.db", disk.name());
    for (std::uint64_t changes = 1; changes < 25; ++changes) {
      disk.power_off_after(changes);
      { const auto cut = Store::open(config); }
      disk.power_on();
    }
    auto [store, report] = opened(config);
    CHECK_FALSE(report.moved_aside);
    CHECK(StoreScenario(seed).difference(store) == "");
  }
}

TEST_CASE("a disk that fails now and then, and forgets what it failed to sync, costs nothing") {
  std::uint64_t failures = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    const TemporaryDirectory directory;
    FaultVfs disk(seed);
    const StoreConfig config = small_config(directory / "store.db", disk.name());
    StoreScenario scenario(seed);
    {
      Store store = std::move(opened(config).store);
      disk.fail_one_in(40);
      for (int i = 0; i < 30; ++i) {
        const StoreBatch batch = scenario.step();
        const StoreBatch* const one = &batch;
        int tries = 0;
        auto report = store.commit({&one, 1});
        for (; !report && tries < 100; ++tries) report = store.commit({&one, 1});
        failures += static_cast<std::uint64_t>(tries);
        REQUIRE(report);
        REQUIRE(report->results[0] == BatchResult::kStored);
      }
      disk.power_off_after(0);
    }
    disk.fail_one_in(0);
    disk.power_on();
    auto [store, report] = opened(config);
    CHECK_FALSE(report.moved_aside);
    CHECK(scenario.difference(store) == "");
  }
  CHECK(failures > 100);
}

// Pages of different ages can by chance make a sound file: no more is promised than that losses are
// noticed nearly always.
TEST_CASE("a disk that lies about syncs is found out") {
  std::uint64_t found_out = 0;
  std::uint64_t missed = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    const TemporaryDirectory directory;
    FaultVfs disk(seed);
    const StoreConfig config = small_config(directory / "store.db", disk.name());
    { const auto made = opened(config); }
    disk.lie(true);
    disk.power_off_after(40 + seed);
    const Life life = live(config, seed, 0);
    disk.power_on();
    disk.lie(false);
    auto store = Store::open(config);
    if (!store) {
      CHECK(store.error().error == StoreError::kCorrupt);  // nothing can be moved in this disk
      ++found_out;
      continue;
    }
    const std::uint64_t found = steps_in(store->store);
    if (found >= life.acknowledged && !store->report.rolled_back) continue;
    ++(store->report.rolled_back ? found_out : missed);
    if (!store->report.rolled_back) continue;
    for (const StoredLayer& layer : store->store.layers()) CHECK(layer.closed == layer.head.own);
    StoreScenario scenario = StoreScenario::after(seed, found);
    CHECK(commit_one(store->store, scenario.step()) ==
          (found == 0 ? BatchResult::kStored : BatchResult::kLayerClosed));
  }
  CHECK(found_out > 20 * missed);
  CHECK(found_out > 20);
  MESSAGE("losses found out: " << found_out << ", missed: " << missed);
}
