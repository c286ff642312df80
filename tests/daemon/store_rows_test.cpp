// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/store_rows.hpp"

#include <doctest/doctest.h>

#include "daemon/replication/item_wire.hpp"
#include "tests/core/layer/replica_steps.hpp"

namespace warren {
namespace {

using replication::Item;
using replication::ItemKind;
using replication::LogId;

Item message(std::uint8_t text, std::optional<MemberId> to = std::nullopt) {
  return {ItemKind::kMessage, to, {1, 2}, {text, 0, 255}};
}

replication::StoredLog log_with(const LogId& id, bool own) {
  replication::StoredLog log{id, own, {}, {}, {}};
  log.voided.add({1, 4});
  log.voided.add({6, 7});
  log.seen.add({0, 12});
  log.items[4] = message(4);
  log.items[11] = message(11, MemberId{9});
  return log;
}

// As a store would hand it out.
struct Rows {
  std::vector<LogItem> items;
  std::map<std::string, std::vector<std::uint8_t>> states;

  void write(const replication::StoreBatch& batch) {
    const StoreBatch rows = rows_of(batch);
    for (const LogItemId& gone : rows.erased_items) {
      std::erase_if(items, [&](const LogItem& item) { return item.id == gone; });
    }
    for (const LogItem& item : rows.items) items.push_back(item);
    for (const auto& [name, state] : rows.states) states[name] = state;
  }
};

bool same(const replication::StoredLog& a, const replication::StoredLog& b) {
  return a.id == b.id && a.own == b.own && a.voided == b.voided && a.seen == b.seen &&
         a.items == b.items;
}

}  // namespace

TEST_CASE("logs come out of their rows as they went in") {
  const replication::StoredLog own = log_with({7, 0xFFFF'FFFF'FFFF'FFFF}, true);
  const replication::StoredLog other = log_with({9, 1}, false);
  Rows rows;
  rows.write({1, {}, {own, other}});
  CHECK(rows.items.size() == 4);
  CHECK(rows.items[1].destination == MemberId{9});
  CHECK(rows.items[0].own);
  CHECK_FALSE(rows.items[2].own);
  const StoredLogs read = logs_of(rows.items, rows.states);
  CHECK(read.refused == 0);
  REQUIRE(read.logs.size() == 2);
  CHECK(same(read.logs[0], own));
  CHECK(same(read.logs[1], other));
}

TEST_CASE("an item that counts no more goes from the rows") {
  replication::StoredLog log = log_with({7, 5}, true);
  Rows rows;
  rows.write({1, {}, {log}});
  log.items[4] = std::nullopt;
  log.voided.add({4, 5});
  rows.write({2, {}, {log}});
  const StoredLogs read = logs_of(rows.items, rows.states);
  REQUIRE(read.logs.size() == 1);
  CHECK_FALSE(read.logs[0].items.contains(4));
  CHECK(read.logs[0].items.contains(11));
  CHECK(read.logs[0].voided.contains(4));
}

TEST_CASE("rows that make no sense are left out and counted") {
  Rows rows;
  rows.write({1, {}, {log_with({7, 5}, true)}});
  const std::string name = rows.states.begin()->first;
  const std::vector<std::uint8_t> whole = rows.states.begin()->second;
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    rows.states[name].assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));
    const StoredLogs read = logs_of(rows.items, rows.states);
    CHECK(read.logs.empty());
    CHECK(read.refused == 3);  // the log, and two items without one
  }
  rows.states[name] = whole;
  rows.items[0].bytes.clear();
  rows.items[1].id.sequence = replication::kItemNumberEnd;
  CHECK(logs_of(rows.items, rows.states).refused == 2);
  CHECK(logs_of({}, {{"log 7", whole}, {"log 7 x", whole}, {"other", whole}}).logs.empty());
}

TEST_CASE("layers keep pose, holdings, blocks and what was forgotten") {
  Replica layer(test::kLayer, kDefaultResolution);
  test::publish(layer, {test::block_with(100, 1, VoxelCode::occupied(3, false))});
  replication::StoredLayer stored{test::kLayer,
                                  kDefaultResolution,
                                  true,
                                  {},
                                  layer.holdings(),
                                  {{3, 9}},
                                  {{100, Revision{1}, layer.codes(100)}}};
  REQUIRE(stored.pose.update_origin({4, 7, Pose{}}) == PoseResult::kTaken);
  const StoreBatch rows = rows_of({1, {stored}, {}});
  REQUIRE(rows.layers.size() == 1);
  const LayerWrite& write = rows.layers[0];
  CHECK(write.head ==
        LayerHead{test::kLayer, kDefaultResolution, true, stored.pose, layer.holdings()});
  CHECK(write.forgotten == std::vector<KeyInterval>{{3, 9}});
  REQUIRE(write.blocks.size() == 1);
  CHECK(write.blocks[0].changed_at == Revision{1});
}

}  // namespace warren
