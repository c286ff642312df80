// SPDX-License-Identifier: Apache-2.0
// Orders of a base without a radio: what its store has of them, whatever that does.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <asio/io_context.hpp>
#include <doctest/doctest.h>

#include "daemon/fleet/fleet_mesh.hpp"
#include "tests/daemon/scripted_store.hpp"
#include "tests/daemon/small_fleet.hpp"

namespace warren {
namespace {

using What = FleetOrder::What;

constexpr std::uint32_t kBase = 1;
constexpr std::uint32_t kRobot = 9;
const LayerId kFirst{kRobot, 5, 0xAA};
const LayerId kSecond{kRobot, 0, 0xBB};  // of a robot that lost its disk

std::unique_ptr<Replica> copy_of(const LayerId& id) {
  auto copy = std::make_unique<Replica>(id, kDefaultResolution);
  const std::vector<CodedBlock> blocks{test::floor_block({0, 0, 0}, 1)};
  copy->publish(blocks);
  copy->pose().update_origin({1, kRobot, {}});
  return copy;
}

// A log in which the robot says that this is its layer.
replication::StoredLog word_on(const std::optional<LayerId>& layer, std::uint64_t incarnation,
                               std::int64_t time_us) {
  NodeStatus status{"robot-9", NodeRole::kRobot, time_us, std::nullopt, std::nullopt};
  if (layer) status.layer = NodeStatus::Layer{*layer, {1}, 0, 64};
  replication::Item item;
  item.kind = replication::ItemKind::kStatus;
  item.bytes = encode(status);
  replication::StoredLog log{{kRobot, incarnation}, false, {}, {}, {}};
  log.items[0] = item;
  return log;
}

replication::StoredLog log_of(const Order& order, std::uint64_t incarnation, bool own) {
  replication::StoredLog log{{order.writer, incarnation}, own, {}, {}, {}};
  log.items[0] = item_of(order);
  return log;
}

struct Base {
  static FleetMeshConfig config() {
    FleetMeshConfig config;
    config.replication.self = MemberId{kBase};
    config.log_incarnation = 0xCC;
    config.name = "base";
    config.role = NodeRole::kBase;
    return config;
  }

  void start(const std::vector<LayerId>& copies, std::vector<replication::StoredLog> logs) {
    StoredFleet stored;
    for (const LayerId& id : copies) stored.copies.push_back(copy_of(id));
    stored.logs = std::move(logs);
    mesh.restore(std::move(stored));
    mesh.start();
  }
  template <typename Condition>
  void run_until(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end) io.run_one_until(end);
    REQUIRE(condition());
  }
  using Ordered = tl::expected<FleetDesk::Layers, std::string>;
  Ordered order(const FleetOrder& wanted) {
    std::optional<Ordered> answer;
    mesh.desk().order({}, wanted, [&](const Ordered& ordered) { answer = ordered; });
    run_until([&] { return answer.has_value(); });
    return *answer;
  }
  Ordered order(What what) { return order(FleetOrder{what, "robot-9", std::nullopt, {}}); }
  // So that all there is to be stored is stored.
  void run_batches(std::size_t count) {
    const std::size_t before = store.batches.size();
    run_until([&] { return store.batches.size() >= before + count; });
    run_until([&] { return !mesh.report().storing; });
  }
  std::vector<Order> stored_orders() const {
    std::vector<Order> orders;
    for (const replication::StoredLog& log : store.logs()) {
      for (const auto& [number, item] : log.items) {
        if (item && log.own && read_order(*item)) orders.push_back(*read_order(*item));
      }
    }
    return orders;
  }

  asio::io_context io;
  test::ScriptedStore store{io};
  FleetMap map = test::fleet_map();
  FleetMesh mesh{io, config(), map, store};
};

}  // namespace

TEST_CASE("a node's layers are cleared all together, or none of them is") {
  Base base;
  base.start({kFirst, kSecond}, {word_on(kSecond, 1, 10)});
  base.store.stores = false;
  const auto refused = base.order(What::kClear);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().find("not ordered") != std::string::npos);
  base.store.stores = true;
  base.run_batches(1);
  CHECK(base.stored_orders().empty());
  CHECK_FALSE(base.mesh.desk().orders().is_retracted(kFirst));

  const auto cleared = base.order(What::kClear);
  REQUIRE(cleared.has_value());
  CHECK(cleared->size() == 2);
  CHECK(base.stored_orders().size() == 2);
  CHECK(base.mesh.desk().orders().is_retracted(kFirst));
  CHECK(base.mesh.desk().orders().is_retracted(kSecond));
}

TEST_CASE("an order that could not be stored leaves the one in force that it would have replaced") {
  Base base;
  base.start({kFirst}, {word_on(kFirst, 1, 10)});
  REQUIRE(base.order(What::kRetract).has_value());
  base.store.stores = false;
  REQUIRE_FALSE(base.order(What::kRestore).has_value());
  base.store.stores = true;
  base.run_batches(1);
  const std::vector<Order> orders = base.stored_orders();
  REQUIRE(orders.size() == 1);
  CHECK(orders.front().verb == Order::Verb::kRetract);
  CHECK(base.mesh.desk().orders().is_retracted(kFirst));
}

TEST_CASE("a base that lost its disk holds to its word when its earlier orders come back") {
  Order earlier;
  earlier.verb = Order::Verb::kRetract;
  earlier.revision = 5;
  earlier.writer = kBase;
  earlier.node = kRobot;
  Order now = earlier;
  now.verb = Order::Verb::kRestore;
  now.revision = 1;
  Base base;
  base.start({kFirst},
             {word_on(kFirst, 1, 10), log_of(earlier, 0x11, false), log_of(now, 0x22, true)});
  base.run_batches(1);
  const std::vector<Order> orders = base.stored_orders();
  REQUIRE(orders.size() == 1);
  CHECK(orders.front().verb == Order::Verb::kRestore);
  CHECK(orders.front().revision == 6);
  CHECK_FALSE(base.mesh.desk().orders().is_retracted(kFirst));
}

TEST_CASE("an earlier layer of a node is aligned when it is named") {
  Base base;
  base.start({kFirst, kSecond}, {word_on(kSecond, 1, 10)});
  const auto aligned = base.order(FleetOrder{What::kAlign, "", kFirst, {{2.0, 0.0, 0.0}, 0.0}});
  REQUIRE(aligned.has_value());
  CHECK(*aligned == FleetDesk::Layers{kFirst});
  const std::vector<Order> orders = base.stored_orders();
  REQUIRE(orders.size() == 1);
  CHECK(orders.front().layer == kFirst);
  CHECK(orders.front().correction.translation.x() == 2.0);
  const auto unknown =
      base.order(FleetOrder{What::kAlign, "", LayerId{kRobot, 7, 1}, {{2.0, 0.0, 0.0}, 0.0}});
  CHECK_FALSE(unknown.has_value());
}

TEST_CASE("the layer that a node writes by its own word is its newest, whatever its number") {
  Base base;
  SUBCASE("held here") {
    base.start({kSecond, kFirst}, {word_on(kSecond, 1, 10)});
    const Replica* const newest = base.mesh.newest_copy_of("robot-9");
    REQUIRE(newest != nullptr);
    CHECK(newest->id() == kSecond);
  }
  SUBCASE("not held here yet: none is taken in its place") {
    base.start({kFirst}, {word_on(kSecond, 1, 10)});
    CHECK(base.mesh.newest_copy_of("robot-9") == nullptr);
    const auto aligned = base.order(What::kAlign);
    REQUIRE_FALSE(aligned.has_value());
    CHECK(aligned.error().find("writes now is not held") != std::string::npos);
  }
  SUBCASE("without its word the one of the highest number") {
    base.start({kFirst, kSecond}, {word_on(std::nullopt, 1, 10)});
    CHECK(base.mesh.newest_copy_of("robot-9")->id() == kFirst);
  }
}

}  // namespace warren
