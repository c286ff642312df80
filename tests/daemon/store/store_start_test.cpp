// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sqlite3.h>
#include <unistd.h>

#include "daemon/store/sealed_bytes.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;
using namespace warren::test;

namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<char>;

Bytes read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void run_sql(const fs::path& file, const std::string& sql) {
  sqlite3* connection = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &connection) == SQLITE_OK);
  CHECK(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(connection);
}

StoreError error_of_opening(const StoreConfig& config) {
  const auto store = Store::open(config);
  REQUIRE_FALSE(store);
  CHECK(store.error().text.find(config.file.string()) != std::string::npos);
  return store.error().error;
}

// The files of a store as a kill left them after so many steps: what is not yet in the file is in
// its log.
struct Left {
  Bytes file, log, mark;
};

Left left_after(std::uint32_t seed, int steps, std::uint64_t checkpoint_bytes) {
  const TemporaryDirectory directory;
  StoreConfig config = small_config(directory / "store.db");
  config.checkpoint_bytes = checkpoint_bytes;
  Store store = std::move(opened(config).store);
  StoreScenario scenario(seed);
  for (int i = 0; i < steps; ++i) commit_one(store, scenario.step());
  return {read_file(config.file), read_file(directory / "store.db-wal"),
          read_file(directory / "store.db-commits")};
}

void damage(Bytes& bytes, std::mt19937& random) {
  if (bytes.empty()) return;
  const std::size_t at = random() % bytes.size();
  switch (random() % 4) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      break;
    case 1:
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at + 512, bytes.size())), 0);
      break;
    case 2:
      bytes.resize(at);
      break;
    default:
      for (int i = 0; i < 20; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
  }
}

enum class Outcome { kUnharmed, kMovedAside, kRolledBack, kEmpty };

// Opens what is left; whatever the store then says, it must not be wrong.
Outcome open_damaged(const fs::path& file, std::uint32_t seed, std::uint64_t steps) {
  auto [store, report] = opened(small_config(file));
  const std::uint64_t found = steps_in(store);
  CHECK(StoreScenario::after(seed, found).difference(store) == "");
  if (report.moved_aside) {
    CHECK(report.fresh);
    CHECK(found == 0);
    CHECK(fs::exists(report.moved_aside->to));
    CHECK_FALSE(report.moved_aside->why.empty());
    return Outcome::kMovedAside;
  }
  if (report.fresh) return Outcome::kEmpty;  // cut to nothing
  for (const StoredLayer& layer : store.layers()) {
    CHECK(layer.closed == (layer.head.own && report.rolled_back));
  }
  if (report.rolled_back) return Outcome::kRolledBack;
  CHECK(found == steps);
  return Outcome::kUnharmed;
}

}  // namespace

TEST_CASE("of two processes with one file the second is told who has it") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  {
    const auto first = opened(config);
    const auto second = Store::open(config);
    REQUIRE_FALSE(second);
    CHECK(second.error().error == StoreError::kInUse);
    CHECK(second.error().text.find("pid " + std::to_string(getpid())) != std::string::npos);
  }
  CHECK(Store::open(config));  // the lock is the process's, not the file's
}

TEST_CASE("a store of a later release is not touched") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  { const auto made = opened(config); }
  run_sql(config.file, "PRAGMA user_version = 9");
  const Bytes header_only = read_file(config.file);
  // The header alone proves nothing: its bytes may be damaged.
  {
    const auto store = opened(config);
    CHECK(store.report.moved_aside);
  }
  // What a later release writes: its version, sealed, in the store's own row.
  std::vector<std::uint8_t> row{9, 0, 0, 0, 1, 2, 3};
  seal(0, row);
  std::string hex;
  for (const std::uint8_t byte : row) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  run_sql(config.file, "UPDATE store SET data = x'" + hex + "'; PRAGMA user_version = 9");
  const Bytes before = read_file(config.file);
  CHECK(error_of_opening(config) == StoreError::kNewerVersion);
  CHECK(read_file(config.file) == before);
}

TEST_CASE("somebody else's database is not touched") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  run_sql(config.file, "CREATE TABLE albums (title TEXT); INSERT INTO albums VALUES ('Blue')");
  const Bytes before = read_file(config.file);
  CHECK(error_of_opening(config) == StoreError::kNotAStore);
  CHECK(read_file(config.file) == before);
}

TEST_CASE("a folder that is not there is a clear failure") {
  const TemporaryDirectory directory;
  CHECK(error_of_opening(small_config(directory / "no/store.db")) == StoreError::kIo);
}

TEST_CASE(
    "a damaged file is moved aside, a damaged log found out, and never is the content wrong") {
  constexpr std::uint32_t kTrials = test::kUnderSanitizer ? 20 : 60;
  std::map<Outcome, int> outcomes;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const int steps = 20;
    // Much in the log, or most in the file.
    const Left left = left_after(seed, steps, seed % 2 == 0 ? 1U << 20 : 16U << 10);
    REQUIRE_FALSE(left.log.empty());
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
      CAPTURE(seed);
      CAPTURE(trial);
      std::mt19937 random(1000 * seed + trial);
      const TemporaryDirectory directory;
      Left damaged = left;
      damage(trial % 2 == 0 ? damaged.file : damaged.log, random);
      write_file(directory / "store.db", damaged.file);
      write_file(directory / "store.db-wal", damaged.log);
      write_file(directory / "store.db-commits", damaged.mark);
      ++outcomes[open_damaged(directory / "store.db", seed, steps)];
      // Whatever it was, the next start is an ordinary one.
      const auto [store, report] = opened(small_config(directory / "store.db"));
      CHECK_FALSE(report.moved_aside);
      CHECK_FALSE(report.rolled_back);
    }
  }
  CHECK(outcomes[Outcome::kUnharmed] > 0);
  CHECK(outcomes[Outcome::kMovedAside] > static_cast<int>(kTrials / 3));
  CHECK(outcomes[Outcome::kRolledBack] > static_cast<int>(kTrials / 3));
}

TEST_CASE("an old copy of the file that is put back is found out") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  StoreScenario scenario(5);
  {
    Store store = std::move(opened(config).store);
    for (int i = 0; i < 5; ++i) commit_one(store, scenario.step());
  }
  const Bytes old_copy = read_file(config.file);
  {
    Store store = std::move(opened(config).store);
    for (int i = 0; i < 3; ++i) commit_one(store, scenario.step());
  }
  write_file(config.file, old_copy);
  {
    const auto [store, report] = opened(config);
    CHECK(report.rolled_back);
    CHECK(report.commits_lost >= 3);
  }
  // Closed is closed, at the next start too; another layer may be begun.
  auto [store, report] = opened(config);
  CHECK_FALSE(report.rolled_back);
  StoreScenario again = StoreScenario::after(5, 5);
  CHECK(commit_one(store, again.step()) == BatchResult::kLayerClosed);
  StoreBatch batch;
  batch.layers.push_back({{{1, 1, 4711}, kDefaultResolution, true, {}, Holdings({1})}, {}, {}});
  CHECK(commit_one(store, batch) == BatchResult::kStored);
  // What was lost of it may come back from others that have it, and it stays closed.
  const auto layers = store.layers();
  const auto old = std::find_if(layers.begin(), layers.end(), [](const StoredLayer& layer) {
    return layer.head.own && layer.closed;
  });
  REQUIRE(old != layers.end());
  StoreBatch completed;
  completed.layers.push_back({old->head, {}, {}});
  completed.layers[0].head.own = false;
  completed.layers[0].head.holdings = Holdings({old->head.holdings.highest({}).number + 5});
  CHECK(commit_one(store, completed) == BatchResult::kStored);
  completed.layers[0].head.own = true;
  CHECK(commit_one(store, completed) == BatchResult::kLayerClosed);
}

TEST_CASE("a store that others are ahead of begins anew at its next start, and at no later one") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  StoreScenario scenario(5);
  {
    Store store = std::move(opened(config).store);
    for (int i = 0; i < 10; ++i) commit_one(store, scenario.step());
    StoreBatch word;
    word.is_behind = true;
    CHECK(commit_one(store, word) == BatchResult::kStored);
    commit_one(store, scenario.step());
  }
  {
    const Store::Opened again = opened(config);
    CHECK(again.report.rolled_back);
    for (const StoredLayer& layer : again.store.layers()) CHECK(layer.closed == layer.head.own);
  }
  CHECK_FALSE(opened(config).report.rolled_back);
}

TEST_CASE("damaged files are kept, up to a bound") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  for (int i = 1; i <= 5; ++i) {
    write_file(config.file, Bytes(5000, 'x'));
    const auto [store, report] = opened(config);
    REQUIRE(report.moved_aside);
    CHECK(report.moved_aside->to ==
          directory / ("store.db.corrupt-" + std::to_string(std::min(i, 2))));
  }
}
