// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <random>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/store/store_worker.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;
using namespace warren::test;

namespace {

constexpr std::uint32_t kKills = test::kUnderSanitizer ? 12 : 40;

void acknowledge(int log, std::uint64_t step) {
  if (write(log, &step, sizeof step) != sizeof step) _exit(3);
}

// A child that stores one step after the other until it is killed. Of what is stored it tells by
// the pipe, of nothing else.
[[noreturn]] void store_for_ever(const StoreConfig& config, std::uint32_t seed, std::uint64_t from,
                                 int log) {
  auto opened = Store::open(config);
  if (!opened) _exit(2);
  StoreScenario scenario = StoreScenario::after(seed, from);
  if (seed % 2 == 0) {
    for (;;) {
      const StoreBatch batch = scenario.step();
      const StoreBatch* const one = &batch;
      const auto report = opened->store.commit({&one, 1});
      if (!report || report->results[0] != BatchResult::kStored) _exit(4);
      acknowledge(log, scenario.steps());
    }
  }
  StoreWorker worker(std::move(opened->store), {}, {[](const auto& call) { call(); }});
  for (;;) {
    const StoreBatch batch = scenario.step();
    const auto done = [log, step = scenario.steps()](BatchResult result) {
      if (result != BatchResult::kStored) _exit(5);
      acknowledge(log, step);
    };
    while (!worker.submit(batch, done)) std::this_thread::yield();
  }
}

// Kills it at a random instant; the last step that it acknowledged.
std::uint64_t run_and_kill(const StoreConfig& config, std::uint32_t seed, std::uint64_t from,
                           std::mt19937& random) {
  int pipe_ends[2];
  REQUIRE(pipe(pipe_ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    close(pipe_ends[0]);
    store_for_ever(config, seed, from, pipe_ends[1]);
  }
  close(pipe_ends[1]);
  std::uint64_t acknowledged = from;
  const std::uint64_t enough = from + random() % 40;
  std::uint64_t step = 0;
  while (acknowledged < enough && read(pipe_ends[0], &step, sizeof step) == sizeof step) {
    acknowledged = step;
  }
  for (std::uint64_t spins = random() % 2'000'000; spins > 0; --spins) asm volatile("");
  kill(child, SIGKILL);
  while (read(pipe_ends[0], &step, sizeof step) == sizeof step) acknowledged = step;
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  return acknowledged;
}

}  // namespace

TEST_CASE("kill -9 at any instant loses nothing that was acknowledged") {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    const TemporaryDirectory directory;
    const StoreConfig config = small_config(directory / "store.db");
    std::uint64_t steps = 0;
    for (std::uint32_t kills = 0; kills < kKills / 4; ++kills) {
      CAPTURE(seed);
      CAPTURE(kills);
      const std::uint64_t acknowledged = run_and_kill(config, seed, steps, random);
      auto [store, report] = opened(config);
      CHECK_FALSE(report.moved_aside);
      CHECK_FALSE(report.rolled_back);
      steps = steps_in(store);
      CHECK(steps >= acknowledged);
      CHECK(StoreScenario::after(seed, steps).difference(store) == "");
    }
    CHECK(steps > 0);
  }
}
