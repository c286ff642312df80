// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/publisher.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/temporary_directory.hpp"
#include "tests/support/simulated_scans.hpp"
#include "tests/support/under_sanitizer.hpp"

using namespace warren;
using namespace warren::test;

namespace {

constexpr std::size_t kMapBytes = 50'000'000;
constexpr std::uint32_t kTickBlocks = 200;

struct Took {
  double s = 0.0;
  double cpu_s = 0.0;  // what it would take on a machine that does nothing else, but for the disk
};

double cpu_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Took took(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = cpu_now();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          cpu_now() - cpu_start};
}

void print(const char* what, const Took& took) {
  std::printf("  %-44s %6.2f s, of the CPU %5.2f s\n", what, took.s, took.cpu_s);
}

// Rooms side by side, each seen from many places, until the map has this size.
SelfMap large_map() {
  SelfMap room(SelfMapConfig{});
  for (const auto& scan : walk_through_room(Room{}, Lidar{64, 512, -0.8F, 0.8F, 0.02F}, 30)) {
    room.integrate(scan.view());
    std::vector<VoxelCost> costs;
    room.for_each_known_voxel({}, [&](const VoxelKey& key, VoxelState state, float) {
      const float cost = static_cast<float>((key.x * 7 + key.y * 3) & 15) / 40.0F;
      if (state == VoxelState::kOccupied && key.z < -10) costs.push_back({key, cost, 0.8F});
    });
    room.fuse_costs(costs);
  }
  SelfMap map(SelfMapConfig{});
  const KeyBox box = *room.bounds();
  const BlockKey low = block_of(box.low);
  const BlockKey high = block_of(box.high);
  for (std::int32_t number = 0; map.memory_bytes() < kMapBytes; ++number) {
    for (const BlockKey& key : room.blocks_changed_since(0)) {
      BlockState state = *room.export_block(key);
      state.key.x += number % 16 * (high.x - low.x + 1);
      state.key.y += number / 16 * (high.y - low.y + 1);
      REQUIRE(map.import_block(state));
    }
  }
  return map;
}

// The map and its layer, as one tick each of so many blocks.
std::vector<StoreBatch> batches_of(const SelfMap& map, Replica& layer, std::size_t blocks) {
  std::vector<StoreBatch> batches;
  std::vector<BlockKey> keys = map.blocks_changed_since(0);
  for (std::size_t from = 0; from < keys.size(); from += blocks) {
    const auto some = std::span(keys).subspan(from, std::min(blocks, keys.size() - from));
    StoreBatch& batch = batches.emplace_back();
    SelfLayerWrite write;
    write.head.config = map.config();
    write.head.cursor = map.cursor();
    std::vector<CodedBlock> coded;
    for (const BlockKey& key : some) {
      write.blocks.push_back(*map.export_block(key));
      coded.push_back({ordinal_of(key), codes_of(map, key)});
    }
    const Revision before = layer.holdings().at(0);
    const Claim told{{}, before, layer.publish(coded)};
    batch.self_layers.push_back(std::move(write));
    batch.layers.push_back(write_of(layer, true, {&told, 1}));
  }
  return batches;
}

void commit_all(Store& store, const std::vector<StoreBatch>& batches) {
  for (const StoreBatch& batch : batches) {
    REQUIRE(commit_one(store, batch) == BatchResult::kStored);
  }
}

}  // namespace

TEST_CASE("figures of a map of 50 MB, printed") {
  if (test::kUnderSanitizer) {
    MESSAGE("SKIPPED: they would be those of the sanitizer");
    return;
  }
  const SelfMap map = large_map();
  Replica layer({1, 0, 5}, kDefaultResolution);
  const auto batches = batches_of(map, layer, 4096);
  const TemporaryDirectory directory;
  StoreConfig config;
  config.file = directory / "store.db";
  Took write;
  {
    Store store = std::move(opened(config).store);
    write = took([&] { commit_all(store, batches); });
  }
  std::optional<Store::Opened> start;
  const Took open = took([&] { start = opened(config); });
  Store& store = start->store;
  CHECK(start->report.blocks == 2 * map.counts().blocks);
  const Took read_map = took([&] {
    const SelfMap read = *store.self_map(store.self_layers()[0]);
    CHECK(read.counts().blocks == map.counts().blocks);
  });
  const Took read_layer = took([&] {
    const Replica read = *store.replica(store.layers()[0].head);
    CHECK(read.digest().root() == layer.digest().root());
  });
  const auto blocks = static_cast<double>(map.counts().blocks);
  const auto bytes = static_cast<double>(start->report.bytes);
  std::printf("map of %.1f MB, %.0f blocks; file %.1f MB, %.0f bytes per block (map and layer)\n",
              static_cast<double>(map.memory_bytes()) / 1e6, blocks, bytes / 1e6, bytes / blocks);
  print("write all", write);
  print("start: open and check", open);
  print("start: self-map into memory", read_map);
  print("start: layer into memory", read_layer);

  // Ticks of blocks that lie together, as a robot changes them.
  Replica again({1, 1, 6}, kDefaultResolution);
  const auto ticks = batches_of(map, again, kTickBlocks);
  const std::size_t count = std::min<std::size_t>(ticks.size(), 300);
  const Took tick = took([&] {
    for (std::size_t i = 0; i < count; ++i) commit_one(store, ticks[i]);
  });
  print(("commits of 200 blocks in map and layer: " + std::to_string(count)).c_str(), tick);
  const Took small = took([&] {
    for (std::uint64_t i = 0; i < 500; ++i) {
      StoreBatch batch;
      batch.counters["n"] = i;
      commit_one(store, batch);
    }
  });
  print("commits of one counter: 500", small);
}
