// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/daemon/store/opened_store.hpp"
#include "tests/daemon/store/store_scenario.hpp"
#include "tests/daemon/temporary_directory.hpp"

using namespace warren;
using namespace warren::test;

namespace {

LayerWrite layer_write(const LayerId& id, bool own, Revision held,
                       std::vector<StoredBlock> blocks = {}) {
  return {{id, kDefaultResolution, own, {}, Holdings(held)}, {}, std::move(blocks)};
}

StoreBatch batch_of(LayerWrite write) {
  StoreBatch batch;
  batch.layers.push_back(std::move(write));
  return batch;
}

StoredBlock some_block(BlockOrdinal ordinal, std::uint32_t changed_at) {
  Random random(ordinal + changed_at);
  return {ordinal, {changed_at}, CodeBlock(random_codes(random))};
}

const LayerId kOwn{1, 0, 77};
const LayerId kTheirs{2, 0, 88};

}  // namespace

TEST_CASE("a fresh store is empty and says so; one that is opened again says that too") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  {
    auto [store, report] = opened(config);
    CHECK(report.fresh);
    CHECK_FALSE(report.recovered);
    CHECK(StoreScenario(1).difference(store) == "");
  }
  auto [store, report] = opened(config);
  CHECK_FALSE(report.fresh);
  CHECK_FALSE(report.moved_aside);
  CHECK_FALSE(report.rolled_back);
}

TEST_CASE("what was stored is there after a restart, whatever the steps") {
  CHECK(rc::check("all of it", [] {
    const auto seed = *rc::gen::inRange(0U, 100'000U);
    const auto lives = *rc::gen::inRange(1, 4);
    const TemporaryDirectory directory;
    const StoreConfig config = small_config(directory / "store.db");
    StoreScenario scenario(seed);
    for (int life = 0; life < lives; ++life) {
      Store store = std::move(opened(config).store);
      RC_ASSERT(scenario.difference(store) == "");
      for (int steps = *rc::gen::inRange(0, 12); steps > 0; --steps) {
        RC_ASSERT(commit_one(store, scenario.step()) == BatchResult::kStored);
      }
      RC_ASSERT(scenario.difference(store) == "");
    }
    auto [store, report] = opened(config);
    RC_ASSERT(scenario.difference(store) == "");
    RC_ASSERT(report.self_layers == (scenario.steps() > 0 ? 1U : 0U));
    RC_ASSERT(report.layers == (scenario.steps() > 0 ? 2U : 0U));
  }));
}

TEST_CASE("a restored layer goes on: a copy of it follows as if nothing had been") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  StoreScenario scenario(3);
  {
    Store store = std::move(opened(config).store);
    for (int i = 0; i < 20; ++i) commit_one(store, scenario.step());
  }
  Store store = std::move(opened(config).store);
  Replica copy(scenario.own().id(), kDefaultResolution);
  for_each_packet(scenario.own(), {{}, {}, 1200}, [&](const DiffPacket& packet) {
    return copy.apply(copy.id(), packet.bytes) == ApplyResult::kApplied;
  });
  for (const StoredLayer& layer : store.layers()) {
    if (layer.head.id != copy.id()) continue;
    Replica again = *store.replica(layer.head);
    const Revision before = again.holdings().at(0);
    again.publish(std::vector<CodedBlock>{{4, some_block(4, 1).codes}});
    for_each_packet(again, {{}, before, 1200}, [&](const DiffPacket& packet) {
      return copy.apply(copy.id(), packet.bytes) == ApplyResult::kApplied;
    });
    CHECK(copy.digest().root() == again.digest().root());
  }
}

TEST_CASE("many batches make one transaction, and each is judged by itself") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  Store store = std::move(opened(config).store);
  const std::uint64_t before = store.usage().commits;
  const StoreBatch first = batch_of(layer_write(kOwn, true, {1}, {some_block(3, 1)}));
  const StoreBatch reused = batch_of(layer_write(kOwn, true, {1}, {some_block(4, 1)}));
  const StoreBatch second = batch_of(layer_write(kOwn, true, {2}, {some_block(4, 2)}));
  const std::vector<const StoreBatch*> all{&first, &reused, &second};
  const auto report = store.commit(all);
  REQUIRE(report);
  CHECK(report->results ==
        std::vector{BatchResult::kStored, BatchResult::kRevisionReused, BatchResult::kStored});
  CHECK(store.usage().commits == before + 1);
}

TEST_CASE("no revision of an own layer is written twice") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  {
    Store store = std::move(opened(config).store);
    CHECK(commit_one(store, batch_of(layer_write(kOwn, true, {5}, {some_block(3, 5)}))) ==
          BatchResult::kStored);
  }
  Store store = std::move(opened(config).store);
  const auto try_to = [&](LayerWrite write) {
    return commit_one(store, batch_of(std::move(write)));
  };
  CHECK(try_to(layer_write(kOwn, true, {5}, {some_block(3, 5)})) == BatchResult::kRevisionReused);
  CHECK(try_to(layer_write(kOwn, true, {4})) == BatchResult::kRevisionReused);
  CHECK(try_to(layer_write(kOwn, true, {6}, {some_block(9, 5)})) == BatchResult::kRevisionReused);
  CHECK(try_to(layer_write(kOwn, true, {6}, {some_block(9, 7)})) == BatchResult::kUnsound);
  REQUIRE(store.layers().size() == 1);
  CHECK(store.layers()[0].head.holdings == Holdings({5}));
  CHECK(store.replica(store.layers()[0].head)->codes(3) == some_block(3, 5).codes);
  CHECK(try_to(layer_write(kOwn, true, {5})) == BatchResult::kStored);  // a pose, say
  CHECK(try_to(layer_write(kOwn, true, {6}, {some_block(9, 6)})) == BatchResult::kStored);
  // From others it may come back where it is not continued; then it never is.
  CHECK(try_to(layer_write(kOwn, false, {5})) == BatchResult::kHoldingsLowered);
  CHECK(try_to(layer_write(kOwn, false, {9})) == BatchResult::kStored);
  CHECK(store.layers()[0].head.own);
  CHECK(store.layers()[0].closed);
  CHECK(try_to(layer_write(kOwn, true, {10})) == BatchResult::kLayerClosed);
}

TEST_CASE("what is held of a copy goes down only where it was forgotten") {
  const TemporaryDirectory directory;
  Store store = std::move(opened(small_config(directory / "store.db")).store);
  const auto held = [](std::vector<Holdings::Interval> intervals) {
    return *Holdings::from_intervals(intervals);
  };
  LayerWrite write = layer_write(kTheirs, false, {});
  write.head.holdings = held({{0, {5}}, {1000, {3}}});
  write.blocks = {some_block(10, 5), some_block(2000, 2)};
  REQUIRE(commit_one(store, batch_of(write)) == BatchResult::kStored);
  LayerWrite lowered = write;
  lowered.blocks.clear();
  lowered.head.holdings = held({{0, {5}}, {500, {0}}, {1000, {3}}});
  CHECK(commit_one(store, batch_of(lowered)) == BatchResult::kHoldingsLowered);
  lowered.forgotten = {{500, 999}};
  CHECK(commit_one(store, batch_of(lowered)) == BatchResult::kHoldingsLowered);
  lowered.forgotten = {{500, 1000}};
  CHECK(commit_one(store, batch_of(lowered)) == BatchResult::kStored);
  CHECK(store.replica(store.layers()[0].head)->codes(10) == some_block(10, 5).codes);
}

TEST_CASE("own items keep their numbers for good, those of others may come again") {
  const TemporaryDirectory directory;
  Store store = std::move(opened(small_config(directory / "store.db")).store);
  StoreBatch batch;
  batch.items = {{{{1}, 5, 1}, true, 0, {}, {}, {1, 2}}, {{{2}, 6, 1}, false, 0, {}, {}, {3}}};
  CHECK(commit_one(store, batch) == BatchResult::kStored);
  CHECK(commit_one(store, batch) == BatchResult::kSequenceReused);
  batch.items.erase(batch.items.begin());
  batch.items[0].bytes = {9, 9};
  CHECK(commit_one(store, batch) == BatchResult::kStored);
  CHECK(store.items()->at(1).bytes == std::vector<std::uint8_t>{3});
}

TEST_CASE("a batch that is refused in one part leaves nothing of the others") {
  const TemporaryDirectory directory;
  Store store = std::move(opened(small_config(directory / "store.db")).store);
  StoreBatch batch = batch_of(layer_write(kTheirs, false, {2}, {some_block(3, 3)}));
  batch.counters["seen"] = 1;
  CHECK(commit_one(store, batch) == BatchResult::kUnsound);
  CHECK(store.counters()->empty());
  CHECK(store.layers().empty());
}

TEST_CASE("a layer that is erased is gone with its blocks") {
  const TemporaryDirectory directory;
  const StoreConfig config = small_config(directory / "store.db");
  {
    Store store = std::move(opened(config).store);
    commit_one(store, batch_of(layer_write(kTheirs, false, {2}, {some_block(3, 2)})));
    StoreBatch batch;
    batch.erased_layers = {kTheirs};
    CHECK(commit_one(store, batch) == BatchResult::kStored);
    CHECK(commit_one(store, batch_of(layer_write(kOwn, true, {1}, {some_block(8, 1)}))) ==
          BatchResult::kStored);
  }
  auto [store, report] = opened(config);
  CHECK(report.blocks == 1);
  CHECK(store.layers().size() == 1);
}
