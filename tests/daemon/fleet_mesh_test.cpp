// SPDX-License-Identifier: Apache-2.0
// What a node without a radio hands to its store, and what it does when that refuses.
#include "daemon/fleet/fleet_mesh.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include <asio/io_context.hpp>

#include "daemon/store/store.hpp"
#include "tests/daemon/scripted_store.hpp"
#include "tests/daemon/small_fleet.hpp"
#include "tests/daemon/temporary_directory.hpp"

namespace warren {
namespace {

// A real store behind a driver that refuses when it is told to.
class RefusingStore final : public StorePort {
 public:
  RefusingStore(asio::io_context& io, const std::filesystem::path& file)
      : io_(io), store_(std::move(Store::open({.file = file})->store)) {}
  void write(StoreBatch batch, std::function<void(bool)> done) override {
    bool is_stored = false;
    if (!refuses) {
      const StoreBatch* const only = &batch;
      const auto report = store_.commit({&only, 1});
      REQUIRE(report.has_value());
      results.push_back(report->results.at(0));
      is_stored = results.back() == BatchResult::kStored;
    }
    ++written;
    asio::post(io_, [done = std::move(done), is_stored] { done(is_stored); });
  }

  std::vector<BatchResult> results;
  std::size_t written = 0;
  bool refuses = false;

 private:
  asio::io_context& io_;
  Store store_;
};

struct Node {
  Node() {
    map.on_open([this](const OwnLayer& layer) { mesh.on_opened(layer); });
    mesh.start();
  }
  static FleetMeshConfig config() {
    FleetMeshConfig config;
    config.replication.self = MemberId{7};
    config.log_incarnation = 1;
    return config;
  }
  void tick(LayerChanges changes) {
    map.tick({&changes, 1});
    mesh.on_ticked({});
  }
  // Until so many batches were written, for at most ten seconds.
  void run_until_written(std::size_t batches) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (store.batches.size() < batches && std::chrono::steady_clock::now() < end) {
      io.run_one_until(end);
    }
    REQUIRE(store.batches.size() == batches);
  }
  // The revision of the pose of the own layer in that batch.
  std::optional<std::uint32_t> pose_in(std::size_t batch) const {
    const LayerId id = map.own_layers().at(0).layer().id();
    for (const LayerWrite& write : store.batches.at(batch).layers) {
      if (write.head.id == id) return write.head.pose.origin().revision;
    }
    return std::nullopt;
  }

  asio::io_context io;
  test::ScriptedStore store{io};
  FleetMap map = test::fleet_map();
  FleetMesh mesh{io, config(), map, store};
};

}  // namespace

TEST_CASE("what a store refused it takes the next time, with what came before stored already") {
  const TemporaryDirectory directory;
  asio::io_context io;
  RefusingStore store(io, directory / "store.db");
  FleetMap map = test::fleet_map();
  FleetMesh mesh(io, Node::config(), map, store);
  map.on_open([&](const OwnLayer& layer) { mesh.on_opened(layer); });
  mesh.start();
  const auto write_after = [&](LayerChanges changes) {
    map.tick({&changes, 1});
    mesh.on_ticked({});
    const std::size_t before = store.written;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (store.written == before && std::chrono::steady_clock::now() < end) {
      io.run_one_until(end);
    }
    REQUIRE(store.written == before + 1);
  };
  LayerChanges changes = test::changes_of({test::floor_block({0, 0, 0}, 1)});
  write_after(changes);  // of each kind of item one is stored then
  store.refuses = true;
  changes.T_fleet_map.translation = {0.0, 0.8, 0.0};
  write_after(changes);
  store.refuses = false;
  changes.blocks = test::changes_of({test::floor_block({0, 1, 0}, 1)}).blocks;
  write_after(changes);
  CHECK(store.results == std::vector(2, BatchResult::kStored));
}

TEST_CASE("at the end all is stored, though no neighbour is waited for") {
  Node node;
  node.tick(test::changes_of({test::floor_block({0, 0, 0}, 1)}));
  node.run_until_written(1);
  // The store has not answered yet when this comes.
  node.tick(test::changes_of({test::floor_block({0, 1, 0}, 1)}));
  bool done = false;
  std::size_t written = 0;
  node.mesh.drain(Duration{0}, [&] {
    done = true;
    written = node.store.batches.size();
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!done && std::chrono::steady_clock::now() < end) node.io.run_one_until(end);
  REQUIRE(done);
  REQUIRE(written >= 2);
  CHECK(node.store.batches[1].layers.at(0).head.holdings == Holdings({2}));
}

TEST_CASE("a store that takes nothing is not waited for without end") {
  Node node;
  node.store.stores = false;
  node.tick(test::changes_of({test::floor_block({0, 0, 0}, 1)}));
  bool done = false;
  const auto begin = std::chrono::steady_clock::now();
  node.mesh.drain(Duration{0}, [&] { done = true; });
  while (!done && std::chrono::steady_clock::now() < begin + std::chrono::seconds(60)) {
    node.io.run_one_for(std::chrono::seconds(1));
  }
  CHECK(done);
}

TEST_CASE("a pose is stored once, and again where the store refused it") {
  Node node;
  LayerChanges changes = test::changes_of({test::floor_block({0, 0, 0}, 1)});
  node.tick(changes);
  node.run_until_written(1);
  REQUIRE(node.pose_in(0).has_value());
  changes.blocks.clear();
  changes.T_fleet_map.translation = {0.0, 0.8, 0.0};
  node.store.stores = false;
  node.tick(changes);
  node.run_until_written(2);
  const auto refused = node.pose_in(1);
  REQUIRE(refused.has_value());
  CHECK(*refused == *node.pose_in(0) + 1);
  node.store.stores = true;
  node.run_until_written(3);
  CHECK(node.pose_in(2) == refused);
  changes.T_fleet_map.translation = {0.0, 1.6, 0.0};
  node.tick(changes);
  node.run_until_written(4);
  CHECK(node.pose_in(3) == *refused + 1);
}

}  // namespace warren
