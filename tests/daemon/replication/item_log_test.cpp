// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/item_log.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "daemon/replication/log_book.hpp"
#include "daemon/replication/log_message.hpp"
#include "tests/core/layer/random_codes.hpp"

namespace warren::replication {
namespace {

constexpr LogId kLog{7, 0x55};

Item item(ItemKind kind, std::vector<std::uint8_t> name = {}, std::size_t bytes = 3) {
  Item made;
  made.kind = kind;
  made.name = std::move(name);
  made.bytes.assign(bytes, 9);
  return made;
}

TEST_CASE("items are read as they were written") {
  Item written = item(ItemKind::kCommand, {1, 2});
  written.to = MemberId{4};
  const auto bytes = encode(ItemParcel{kLog, 300, written});
  const auto read = read_item_parcel(bytes);
  REQUIRE(read);
  CHECK(read->item == written);
  CHECK(read->number == 300);
  CHECK(read->log == kLog);
  for (std::size_t length = 0; length < 18; ++length) {
    CHECK_FALSE(read_item_parcel(std::span(bytes).first(length)));
  }
  LayerPoseItem pose{{1, 2, 3}, true, {}};
  pose.pose.revision = 4;
  pose.pose.pose.translation = {1.5, -2.0, 0.25};
  const auto back = read_layer_pose(item_of(pose));
  REQUIRE(back);
  CHECK(back->pose == pose.pose);
  CHECK(back->correction);
  mesh::ByteRanges taken;
  taken.add({3, 9});
  taken.add({20, 21});
  CHECK(read_receipt(item_of(ReceiptItem{kLog, taken}))->taken == taken);
  LogAnnouncement announcement{kLog, 2, MemberId{0}, taken};
  CHECK(read_log_announcement(encode(announcement)) == announcement);
}

TEST_CASE("of one name the latest counts, in whatever order they come") {
  std::vector<ItemNumber> order{0, 1, 2, 3};
  do {
    ItemLog log(kLog, false);
    for (const ItemNumber number : order) log.add(number, item(ItemKind::kStatus, {1}));
    CHECK(log.items().size() == 1);
    CHECK(log.find(3) != nullptr);
    CHECK(log.voided().size() == 3);
    CHECK(log.add(2, item(ItemKind::kStatus, {1})) == AddResult::kKnown);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("a receipt takes what it is for, whether that is here or comes later") {
  ItemLog log(kLog, false);
  Item addressed = item(ItemKind::kMessage);
  addressed.to = MemberId{4};
  CHECK(log.add(0, addressed) == AddResult::kAdded);
  mesh::ByteRanges taken;
  taken.add({0, 2});
  log.on_receipt({5}, taken);
  CHECK(log.find(0) != nullptr);
  log.on_receipt({4}, taken);
  CHECK(log.find(0) == nullptr);
  CHECK(log.add(1, addressed) == AddResult::kReplaced);
  CHECK(log.add(2, addressed) == AddResult::kAdded);
}

TEST_CASE("another's log drops the oldest when it is full, trajectories first, commands never") {
  ItemLog log(kLog, false);
  log.add(0, item(ItemKind::kCommand, {}, 250'000));
  for (ItemNumber number = 1; number < 9; ++number) {
    log.add(number, item(ItemKind::kMessage, {}, 250'000));
  }
  for (ItemNumber number = 9; number < 30; ++number) {
    log.add(number, item(ItemKind::kTrajectory, {}, 250'000));
  }
  CHECK(log.memory_bytes() < ItemLog::kBytesMax + 10'000);
  CHECK(log.find(0) != nullptr);
  CHECK(log.find(1) != nullptr);
  CHECK(log.find(9) == nullptr);
  CHECK(log.find(29) != nullptr);
  CHECK_FALSE(log.tellable().contains(9));
  CHECK(log.seen().contains(9));
  CHECK(log.dropped() > 0);
}

TEST_CASE("the own log takes no more than it has room for") {
  ItemLog log(kLog, true);
  ItemNumber number = 0;
  while (log.has_room_for(item(ItemKind::kMessage, {}, 1000))) {
    log.add(number++, item(ItemKind::kMessage, {}, 1000));
  }
  CHECK(number > 3000);
  CHECK(log.next_number() == number);
  CHECK(log.dropped() == 0);
}

TEST_CASE("several items get numbers in a row, or none of them gets one") {
  LogBook book({kLog.origin}, 4);
  REQUIRE(book.open(kLog));
  for (std::size_t i = 0; i + 2 < ItemLog::kItemsMax; ++i) {
    REQUIRE(book.append({}, item(ItemKind::kCommand)));
  }
  const ItemNumber next = book.own()->log.next_number();
  CHECK_FALSE(book.append_all({}, std::vector<Item>(3, item(ItemKind::kCommand))));
  CHECK(book.own()->log.next_number() == next);
  CHECK(book.items_refused() == 3);
  const auto numbers = book.append_all({}, std::vector<Item>(2, item(ItemKind::kCommand)));
  REQUIRE(numbers);
  CHECK(numbers->first == next);
  CHECK(numbers->end == next + 2);
}

}  // namespace
}  // namespace warren::replication
