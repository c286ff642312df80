// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <sys/mount.h>
#include <unistd.h>

#include "tests/daemon/store/fault_vfs.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"

using namespace warren;
using namespace warren::test;

namespace {

constexpr std::uint32_t kSelf = 1;

// A layer's next revision, with some twenty kilobytes of noise.
LayerWrite grow(const LayerId& id, std::uint32_t revision) {
  LayerWrite write{{id, kDefaultResolution, id.origin == kSelf, {}, Holdings({revision})}, {}, {}};
  Random random(id.origin * 1000 + revision);
  for (std::uint32_t i = 0; i < 50; ++i) {
    write.blocks.push_back({revision * 50 + i, {revision}, CodeBlock(random_codes(random))});
  }
  return write;
}

StoreBatch batch_of(LayerWrite write) {
  StoreBatch batch;
  batch.layers.push_back(std::move(write));
  return batch;
}

LogItem item_of(std::uint32_t origin, std::uint64_t sequence, std::vector<MemberId> receipts = {}) {
  return {{{origin}, 5, sequence},
          origin == kSelf,
          0,
          MemberId{9},
          std::move(receipts),
          std::vector<std::uint8_t>(20'000, 7)};
}

bool holds(Store& store, const LayerId& id) {
  for (const StoredLayer& layer : store.layers()) {
    if (layer.head.id == id) return true;
  }
  return false;
}

const LayerId kOwn{kSelf, 0, 1};
LayerId other(std::uint32_t origin) { return {origin, 0, 1}; }

StoreConfig two_megabytes(const std::filesystem::path& file, const char* vfs = nullptr) {
  StoreConfig config = small_config(file, vfs);
  config.checkpoint_bytes = 64U << 10;
  config.disk_bytes_max = (2U << 20) + 8 * config.checkpoint_bytes;
  return config;
}

}  // namespace

TEST_CASE(
    "at the ceiling go items that have arrived, then copies long unchanged, never one's own") {
  const TemporaryDirectory directory;
  const StoreConfig config = two_megabytes(directory / "store.db");
  {
    Store store = std::move(opened(config).store);
    for (std::uint32_t revision = 1; revision <= 10; ++revision) {
      for (const std::uint32_t origin : {2U, 3U, 4U}) {
        commit_one(store, batch_of(grow(other(origin), revision)));
      }
    }
    commit_one(store, batch_of(grow(other(2), 11)));  // now 3 is the longest unchanged
    StoreBatch batch;
    batch.items = {item_of(kSelf, 1), item_of(2, 1, {{9}}), item_of(2, 2)};
    commit_one(store, batch);

    Evictions evicted;
    for (std::uint32_t revision = 1; evicted.layers.empty(); ++revision) {
      const StoreBatch own = batch_of(grow(kOwn, revision));
      const StoreBatch* const one = &own;
      const auto report = store.commit({&one, 1});
      REQUIRE(report);
      REQUIRE(report->results[0] == BatchResult::kStored);
      evicted.layers = report->evicted.layers;
      evicted.items.insert(evicted.items.end(), report->evicted.items.begin(),
                           report->evicted.items.end());
    }
    CHECK(evicted.layers.front() == other(3));
    CHECK(evicted.items == std::vector{LogItemId{{2}, 5, 1}});
    CHECK(holds(store, kOwn));
    CHECK(holds(store, other(2)));
    CHECK(store.usage().file_bytes <= 2U << 20);

    // What was evicted would be stored with holes: it is not, until it comes anew.
    const StoreBatch more = batch_of(grow(other(3), 12));
    const StoreBatch* const one = &more;
    const auto report = store.commit({&one, 1});
    REQUIRE(report);
    CHECK(report->evicted.writes_dropped == 1);
    CHECK_FALSE(holds(store, other(3)));
  }
  Store store = std::move(opened(config).store);
  commit_one(store, batch_of(grow(other(3), 1)));
  CHECK(holds(store, other(3)));
  CHECK(store.items()->size() == 2);
}

TEST_CASE("when only one's own is left, commits fail, and nothing stored is lost") {
  const TemporaryDirectory directory;
  const StoreConfig config = two_megabytes(directory / "store.db");
  std::uint32_t stored = 0;
  {
    Store store = std::move(opened(config).store);
    commit_one(store, batch_of(grow(other(2), 1)));
    for (;;) {
      const StoreBatch own = batch_of(grow(kOwn, stored + 1));
      const StoreBatch* const one = &own;
      auto report = store.commit({&one, 1});
      for (int tries = 0; !report && tries < 3; ++tries) report = store.commit({&one, 1});
      if (!report) {
        CHECK(report.error().error == StoreError::kCeiling);
        break;
      }
      ++stored;
      REQUIRE(stored < 1000);
    }
    CHECK_FALSE(holds(store, other(2)));
    // Small things still fit into what is left.
    StoreBatch small;
    small.counters["alive"] = 1;
    CHECK(commit_one(store, small) == BatchResult::kStored);
  }
  CHECK(stored > 50);
  Store store = std::move(opened(config).store);
  REQUIRE(store.layers().size() == 1);
  CHECK(store.layers()[0].head.holdings == Holdings({stored}));
  const Replica layer = *store.replica(store.layers()[0].head);
  CHECK(layer.codes(stored * 50) == grow(kOwn, stored).blocks[0].codes);
}

TEST_CASE("a batch that finds the disk full is stored when there is room again") {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    const TemporaryDirectory directory;
    FaultVfs disk(seed);
    const StoreConfig config = small_config(directory / "store.db", disk.name());
    StoreScenario scenario(seed);
    {
      Store store = std::move(opened(config).store);
      int refused = 0;
      for (int i = 0; i < 60; ++i) {
        const StoreBatch batch = scenario.step();
        const StoreBatch* const one = &batch;
        // The copy and items of others may go meanwhile: only own data is compared.
        if (i == 20 + static_cast<int>(seed % 20)) disk.set_capacity(disk.bytes() + 512 * seed);
        auto report = store.commit({&one, 1});
        for (int tries = 0; !report && tries < 20; ++tries) {
          CHECK(report.error().error == StoreError::kDiskFull);
          ++refused;
          if (tries == 5) disk.set_capacity(~std::uint64_t{0});
          report = store.commit({&one, 1});
        }
        REQUIRE(report);
        REQUIRE(report->results[0] == BatchResult::kStored);
      }
      CHECK(refused > 0);
      disk.power_off_after(0);
    }
    disk.power_on();
    auto [store, report] = opened(config);
    CHECK_FALSE(report.moved_aside);
    CHECK_FALSE(report.rolled_back);
    CHECK(steps_in(store) == 60);
    for (const StoredLayer& layer : store.layers()) {
      if (!layer.head.own) continue;
      CHECK(store.replica(layer.head)->digest().root() == scenario.own().digest().root());
    }
  }
}

TEST_CASE("a real disk that is full refuses, and what was stored is there") {
  const TemporaryDirectory directory;
  const std::filesystem::path mount_point = directory / "";
  if (geteuid() != 0 || mount("tmpfs", mount_point.c_str(), "tmpfs", 0, "size=1m,mode=700") != 0) {
    MESSAGE("SKIPPED: only root can mount a small file system");
    return;
  }
  std::uint32_t stored = 0;
  {
    StoreConfig config = small_config(directory / "store.db");
    Store store = std::move(opened(config).store);
    for (;;) {
      const StoreBatch own = batch_of(grow(kOwn, stored + 1));
      const StoreBatch* const one = &own;
      const auto report = store.commit({&one, 1});
      if (!report) {
        CHECK(report.error().error == StoreError::kDiskFull);
        break;
      }
      ++stored;
      REQUIRE(stored < 1000);
    }
  }
  CHECK(stored > 5);
  {
    auto [store, report] = opened(small_config(directory / "store.db"));
    CHECK_FALSE(report.moved_aside);
    CHECK(store.layers().at(0).head.holdings == Holdings({stored}));
  }
  CHECK(umount(mount_point.c_str()) == 0);
}
