// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/operator_orders.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "daemon/fleet/orders_again.hpp"

namespace warren {
namespace {

constexpr std::uint32_t kRobot = 7;
constexpr std::uint32_t kBase = 1;
constexpr std::uint32_t kSecondBase = 2;
const LayerId kLayer{kRobot, 0, 0x55};
const LayerId kLater{kRobot, 1, 0x66};

Order order_of(Order::Verb verb, std::uint32_t revision, std::uint32_t writer,
               std::optional<LayerId> layer = kLayer) {
  Order order;
  order.verb = verb;
  order.revision = revision;
  order.writer = writer;
  order.node = kRobot;
  order.layer = layer;
  if (verb == Order::Verb::kAlign) order.correction.translation = {1.5, -2.0, 0.25};
  return order;
}

void note(OperatorOrders& orders, const Order& order) {
  CHECK(orders.note(order.writer, item_of(order)));
}

}  // namespace

TEST_CASE("an order is read as it was written, cut at no length, and under its own name alone") {
  for (const Order& order :
       {order_of(Order::Verb::kRetract, 3, kBase, std::nullopt),
        order_of(Order::Verb::kRestore, 4, kBase), order_of(Order::Verb::kAlign, 5, kBase)}) {
    const replication::Item item = item_of(order);
    CHECK(replication::class_of(item.kind) == mesh::ParcelClass::kControl);
    CHECK(item.name.size() <= replication::Item::kNameMax);
    const auto read = read_order(item);
    REQUIRE(read.has_value());
    CHECK(read->verb == order.verb);
    CHECK(read->revision == order.revision);
    CHECK(read->writer == order.writer);
    CHECK(read->layer == order.layer);
    CHECK(read->correction.translation == order.correction.translation);
    for (std::size_t length = 0; length < item.bytes.size(); ++length) {
      replication::Item cut = item;
      cut.bytes.resize(length);
      CHECK_FALSE(read_order(cut).has_value());
    }
    replication::Item renamed = item;
    renamed.name.back() = 0x7E;
    CHECK_FALSE(read_order(renamed).has_value());
  }
  const std::vector<std::uint8_t> golden{0x33, 0, 3, 0, 0, 0, 1, 0, 0, 0, 7, 0, 0, 0, 0};
  CHECK(item_of(order_of(Order::Verb::kRetract, 3, kBase, std::nullopt)).bytes == golden);
}

TEST_CASE("orders count once their writer is known to be a base, and no longer than that") {
  OperatorOrders orders;
  note(orders, order_of(Order::Verb::kRetract, 1, kBase));
  CHECK_FALSE(orders.is_retracted(kLayer));
  CHECK(orders.settle({}));
  CHECK_FALSE(orders.settle({}));
  CHECK(orders.unauthorised() == 1);
  CHECK(orders.settle({kBase}));
  CHECK(orders.is_retracted(kLayer));
  CHECK_FALSE(orders.is_retracted(kLater));
  CHECK(orders.unauthorised() == 0);
  CHECK(orders.settle({kSecondBase}));
  CHECK_FALSE(orders.is_retracted(kLayer));
}

TEST_CASE("an order in somebody else's log, or none at all, is refused and counted") {
  OperatorOrders orders;
  CHECK_FALSE(orders.note(kSecondBase, item_of(order_of(Order::Verb::kRetract, 1, kBase))));
  replication::Item noise;
  noise.kind = replication::ItemKind::kCommand;
  noise.bytes = {1, 2, 3};
  CHECK_FALSE(orders.note(kBase, noise));
  CHECK(orders.refused() == 2);
  CHECK(orders.size() == 0);
}

TEST_CASE("the latest word on a layer counts, be it on the layer or on its node") {
  OperatorOrders orders;
  orders.settle({kBase});
  note(orders, order_of(Order::Verb::kRetract, 1, kBase, std::nullopt));
  CHECK(orders.is_retracted(kLayer));
  CHECK(orders.is_retracted(kLater));
  CHECK(orders.next_revision(kRobot) == 2);
  note(orders, order_of(Order::Verb::kRestore, 2, kBase, kLater));
  CHECK(orders.is_retracted(kLayer));
  CHECK_FALSE(orders.is_retracted(kLater));
  note(orders, order_of(Order::Verb::kRestore, 3, kBase, std::nullopt));
  CHECK_FALSE(orders.is_retracted(kLayer));
  CHECK(orders.next_revision(kRobot + 1) == 1);
}

TEST_CASE("two bases that disagree leave the same behind in whatever order their word comes") {
  std::vector<Order> said{
      order_of(Order::Verb::kRetract, 1, kBase), order_of(Order::Verb::kRestore, 1, kSecondBase),
      order_of(Order::Verb::kAlign, 2, kBase), order_of(Order::Verb::kAlign, 3, kSecondBase)};
  said[3].correction.translation.x() = 9.0;
  std::vector<std::size_t> turn{0, 1, 2, 3};
  do {
    OperatorOrders orders;
    orders.settle({kBase, kSecondBase});
    for (const std::size_t i : turn) note(orders, said[i]);
    // The higher writer's among equal revisions; the higher revision.
    CHECK_FALSE(orders.is_retracted(kLayer));
    REQUIRE(orders.correction_of(kLayer).has_value());
    CHECK(orders.correction_of(kLayer)->pose.translation.x() == 9.0);
    CHECK(orders.correction_of(kLayer)->writer == kSecondBase);
  } while (std::next_permutation(turn.begin(), turn.end()));
}

TEST_CASE("an older order of the same base changes nothing when it comes late") {
  OperatorOrders orders;
  orders.settle({kBase});
  note(orders, order_of(Order::Verb::kRestore, 5, kBase));
  note(orders, order_of(Order::Verb::kRetract, 4, kBase));
  CHECK_FALSE(orders.is_retracted(kLayer));
  CHECK(orders.next_revision(kRobot) == 6);
}

TEST_CASE("orders of a base that lost its disk are given again above those of its earlier life") {
  const Order earlier = order_of(Order::Verb::kRetract, 5, kBase);
  const std::vector<Order> now{order_of(Order::Verb::kRetract, 2, kBase, kLater),
                               order_of(Order::Verb::kRestore, 1, kBase, std::nullopt)};
  OperatorOrders orders;  // of anybody who has been there all the time
  orders.settle({kBase});
  note(orders, earlier);
  for (const Order& order : now) note(orders, order);
  CHECK(orders.is_retracted(kLayer));

  std::vector<Order> again = orders_to_give_again(now, {earlier});
  REQUIRE(again.size() == 2);
  for (Order& order : again) {
    order.revision = orders.next_revision(kRobot);
    note(orders, order);
  }
  CHECK_FALSE(orders.is_retracted(kLayer));
  CHECK(orders.is_retracted(kLater));
  CHECK(orders_to_give_again(again, {earlier}).empty());
}

TEST_CASE("orders that an earlier life's do not undo are not given again") {
  const std::vector<Order> now{order_of(Order::Verb::kRestore, 3, kBase)};
  CHECK(orders_to_give_again(now, {}).empty());
  CHECK(orders_to_give_again(now, {order_of(Order::Verb::kRetract, 2, kBase)}).empty());
  CHECK(orders_to_give_again(now, {order_of(Order::Verb::kAlign, 9, kBase)}).empty());
  CHECK(orders_to_give_again(now, {order_of(Order::Verb::kRetract, 9, kBase, kLater)}).empty());
  Order elsewhere = order_of(Order::Verb::kRetract, 9, kBase, std::nullopt);
  elsewhere.node = kRobot + 1;
  CHECK(orders_to_give_again(now, {elsewhere}).empty());
  // Of equal ones nobody can say which is the later.
  CHECK(orders_to_give_again(now, {order_of(Order::Verb::kRetract, 3, kBase)}).size() == 1);
}

TEST_CASE("what a robot says it orders does not raise the revision that a base has to beat") {
  OperatorOrders orders;
  orders.settle({kBase});
  note(orders, order_of(Order::Verb::kRetract, UINT32_MAX, kRobot));
  CHECK(orders.next_revision(kRobot) == 1);
}

}  // namespace warren
