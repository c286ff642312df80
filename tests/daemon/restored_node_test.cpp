// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/restored_node.hpp"

#include <doctest/doctest.h>

#include "core/layer/publisher.hpp"
#include "daemon/fleet/store_rows.hpp"
#include "tests/core/layer/replica_steps.hpp"
#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/temporary_directory.hpp"

namespace warren {
namespace {

constexpr LayerId kOwn{7, 3, 0x77};
constexpr LayerId kOther{9, 0, 0x99};

// A robot of one layer with something in it, a copy of another's layer, and a log.
StoreBatch life() {
  Replica own(kOwn, kDefaultResolution);
  test::publish(own, {test::block_with(100, 1, VoxelCode::occupied(3, false))});
  Replica copy(kOther, kDefaultResolution);
  test::publish(copy, {test::block_with(200, 2, VoxelCode::free())});
  const Claim all{{}, Revision{}, Revision{1}};
  StoreBatch batch;
  batch.layers = {write_of(own, true, {&all, 1}), write_of(copy, false, {&all, 1})};
  SelfLayerWrite self;
  self.head.number = kOwn.number;
  self.head.frame_epoch = 12;
  self.head.scans = 5;
  self.head.cursor = 5;
  batch.self_layers = {self};
  replication::StoredLog log{{7, 1}, true, {}, {}, {}};
  log.items[0] = replication::Item{replication::ItemKind::kMessage, std::nullopt, {}, {1}};
  log.seen.add({0, 1});
  StoreBatch rows = rows_of({1, {}, {log}});
  batch.items = rows.items;
  batch.states = rows.states;
  return batch;
}

struct Lived {
  TemporaryDirectory directory;
  Store::Opened opened = test::opened(test::small_config(directory / "node.db"));

  Lived() { REQUIRE(test::commit_one(opened.store, life()) == BatchResult::kStored); }
  StoredNode restored(const SelfMapConfig& config, bool rolled_back = false) {
    StartReport report;
    report.rolled_back = rolled_back;
    auto node = restore_node(opened.store, report, config);
    REQUIRE(node.has_value());
    return std::move(*node);
  }
};

}  // namespace

TEST_CASE("a node goes on with what its store has") {
  Lived lived;
  const StoredNode node = lived.restored(SelfMapConfig{});
  REQUIRE(node.own.size() == 1);
  CHECK(node.own[0].layer.id() == kOwn);
  CHECK(node.own[0].layer.holdings().at(0) == Revision{1});
  REQUIRE(node.map.layers.size() == 1);
  CHECK(node.map.layers[0].first.frame_epoch == 12);
  CHECK(node.map.layers[0].second.cursor() == 5);
  CHECK(node.map.next_number == 4);
  REQUIRE(node.fleet.copies.size() == 1);
  CHECK(node.fleet.copies[0]->id() == kOther);
  REQUIRE(node.fleet.logs.size() == 1);
  CHECK(node.fleet.logs[0].own);
  CHECK(node.layers_ended == 0);
}

TEST_CASE("with another config the own layer is kept, but not continued") {
  Lived lived;
  SelfMapConfig config;
  config.resolution_m = 0.2;
  const StoredNode node = lived.restored(config);
  CHECK(node.own.empty());
  CHECK(node.map.layers.empty());
  CHECK(node.map.next_number == 4);
  CHECK(node.fleet.copies.size() == 2);
  CHECK(node.layers_ended == 1);
  CHECK(node.fleet.logs.at(0).own);
}

TEST_CASE("a log of which numbers may be lost is not continued") {
  Lived lived;
  CHECK_FALSE(lived.restored(SelfMapConfig{}, true).fleet.logs.at(0).own);
}

TEST_CASE("the self-map goes on under a new layer where the old one may not") {
  Lived lived;
  StoreBatch batch = life();
  // Others brought back a revision of it that was lost.
  LayerWrite completed = batch.layers[0];
  completed.head.own = false;
  completed.head.holdings = Holdings({2});
  completed.blocks.clear();
  StoreBatch closing;
  closing.layers = {completed};
  REQUIRE(test::commit_one(lived.opened.store, closing) == BatchResult::kStored);
  StoredNode node = lived.restored(SelfMapConfig{});
  CHECK(node.own.empty());
  CHECK(node.layers_ended == 1);
  REQUIRE(node.map.layers.size() == 1);
  SelfLayerHead head = node.map.layers[0].first;
  CHECK(head.number == 4);
  CHECK(head.frame_epoch == 12);
  CHECK(head.scans == 5);
  CHECK(head.cursor == 0);
  CHECK(node.map.next_number == 5);
  // Once it is stored so, it is that one alone.
  StoreBatch carried;
  carried.self_layers = {{head, {}}};
  carried.self_layers[0].head.cursor = 6;
  REQUIRE(test::commit_one(lived.opened.store, carried) == BatchResult::kStored);
  node = lived.restored(SelfMapConfig{});
  REQUIRE(node.map.layers.size() == 1);
  CHECK(node.map.layers[0].first.number == 4);
  CHECK(node.map.layers[0].first.cursor == 6);
  CHECK(node.map.next_number == 5);
}

TEST_CASE("a map of which nothing was published goes on, and its number is not used again") {
  TemporaryDirectory directory;
  Store::Opened opened = test::opened(test::small_config(directory / "node.db"));
  StoreBatch batch;
  batch.self_layers = {life().self_layers};
  REQUIRE(test::commit_one(opened.store, batch) == BatchResult::kStored);
  const auto node = restore_node(opened.store, {}, SelfMapConfig{});
  REQUIRE(node.has_value());
  CHECK(node->own.empty());
  CHECK(node->map.layers.size() == 1);
  CHECK(node->map.next_number == 4);
}

}  // namespace warren
