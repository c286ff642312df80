// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/message_desk.hpp"

#include <doctest/doctest.h>

namespace warren {
namespace {

using replication::Item;
using replication::ItemKind;
using replication::LogBook;
using replication::LogId;

constexpr MemberId kSelf{1};
constexpr MemberId kOther{2};
constexpr LogId kOwnLog{1, 11};
constexpr LogId kOtherLog{2, 22};
constexpr std::uint64_t kInbox = 99;

Message message_of(const std::string& text, std::optional<MemberId> to = kSelf) {
  Message message;
  message.to = to;
  message.bytes.assign(text.begin(), text.end());
  return message;
}

std::string text_of(const InboxMessage& held) {
  return {held.message.bytes.begin(), held.message.bytes.end()};
}

struct Desk {
  LogBook book{kSelf, 8};
  MessageDesk desk{kSelf, kInbox, book};
  std::uint64_t batch = 0;

  Desk() { REQUIRE(book.open(kOwnLog)); }
  // As the mesh and the store do it.
  void receive(replication::ItemNumber number, const Message& message) {
    book.add({}, {kOtherLog, number, item_of(message)});
    store();
  }
  void store() {
    (void)book.take_batch(++batch);
    (void)book.on_stored({}, batch);
    while (const auto arrived = book.poll_arrived()) {
      desk.take_in(arrived->log, arrived->number, arrived->item);
    }
  }
  std::size_t receipts() const {
    std::size_t count = 0;
    for (const auto& [number, item] : book.logs().front()->log.items()) {
      count += item.kind == ItemKind::kReceipt ? 1 : 0;
    }
    return count;
  }
};

}  // namespace

TEST_CASE("a message is read as it was written, and nothing else is taken for one") {
  Message message = message_of("come here", kOther);
  message.urgent = true;
  message.key = "goal/2";
  message.time_us = 1'700'000'000'000'001;
  const Item item = item_of(message);
  CHECK(item.kind == ItemKind::kUrgentMessage);
  CHECK(read_message(item) == message);
  CHECK(read_message(item_of(message_of("", std::nullopt))) == message_of("", std::nullopt));
  for (std::size_t length = 0; length < 9; ++length) {
    Item cut = item;
    cut.bytes.resize(length);
    CHECK_FALSE(read_message(cut).has_value());
  }
  Item other = item;
  other.bytes[0] = 0x33;
  CHECK_FALSE(read_message(other).has_value());
  other = item;
  other.kind = ItemKind::kStatus;
  CHECK_FALSE(read_message(other).has_value());
  // Of another addressee than its name says; a key that would upset a terminal.
  other = item;
  other.to = std::nullopt;
  CHECK_FALSE(read_message(other).has_value());
  other = item;
  other.name.back() = 0x1B;
  CHECK_FALSE(read_message(other).has_value());
}

TEST_CASE("a message to this node gets its receipt when somebody has fetched it, not before") {
  Desk node;
  node.receive(0, message_of("one"));
  node.receive(1, message_of("two"));
  CHECK(node.receipts() == 0);
  CHECK(node.book.find(kOtherLog)->log.items().size() == 2);
  const InboxExcerpt first = node.desk.read({}, 0, 0);
  REQUIRE(first.messages.size() == 2);
  CHECK(text_of(first.messages[1]) == "two");
  CHECK(first.messages[0].from == kOther);
  CHECK(first.inbox == kInbox);
  // It may not have arrived at its reader yet.
  CHECK(node.receipts() == 0);
  const InboxExcerpt second = node.desk.read({}, first.inbox, first.next);
  CHECK(second.messages.empty());
  CHECK(node.receipts() == 1);
  CHECK(node.book.find(kOtherLog)->log.items().empty());
  // Others may read it all the same.
  CHECK(node.desk.read({}, 0, 0).messages.size() == 2);
}

TEST_CASE("a receipt for a later message says nothing of an earlier one that is not fetched") {
  Desk node;
  node.receive(0, message_of("one"));
  node.receive(1, message_of("two"));
  const InboxExcerpt first = node.desk.read({}, 0, 0);
  node.desk.read({}, first.inbox, first.messages[0].number);
  CHECK(node.book.find(kOtherLog)->log.find(0) == nullptr);
  CHECK(node.book.find(kOtherLog)->log.find(1) != nullptr);
}

TEST_CASE("messages to all and to this node come in, those to others and our own do not") {
  Desk node;
  node.receive(0, message_of("to all", std::nullopt));
  node.receive(1, message_of("to somebody", MemberId{3}));
  node.receive(2, message_of("to us"));
  REQUIRE(node.desk.send({}, message_of("ours", std::nullopt)).has_value());
  node.store();
  const InboxExcerpt excerpt = node.desk.read({}, 0, 0);
  REQUIRE(excerpt.messages.size() == 2);
  CHECK(text_of(excerpt.messages[0]) == "to all");
  CHECK(text_of(excerpt.messages[1]) == "to us");
}

TEST_CASE("a cursor of another inbox begins anew, one beyond the end is taken for the end") {
  Desk node;
  node.receive(0, message_of("one", std::nullopt));
  CHECK(node.desk.read({}, kInbox + 1, 500).messages.size() == 1);
  CHECK(node.desk.read({}, kInbox, 500).messages.empty());
  CHECK(node.desk.read({}, kInbox, 500).next == 1);
}

TEST_CASE("a full inbox drops its oldest messages, and says so") {
  Desk node;
  for (replication::ItemNumber i = 0; i < MessageDesk::kInboxMax + 10; ++i) {
    node.receive(i, message_of(std::to_string(i), std::nullopt));
  }
  CHECK(node.desk.dropped() == 10);
  const InboxExcerpt excerpt = node.desk.read({}, kInbox, 4);
  CHECK(excerpt.missed == 6);
  CHECK(text_of(excerpt.messages.front()) == "10");
}

TEST_CASE("an excerpt is bounded, and the next one goes on") {
  Desk node;
  const std::string long_text(150'000, 'x');
  for (replication::ItemNumber i = 0; i < 5; ++i) {
    node.receive(i, message_of(long_text, std::nullopt));
  }
  std::uint64_t after = 0;
  std::size_t came = 0;
  bool more = true;
  for (int rounds = 0; more; ++rounds) {
    REQUIRE(rounds < 5);
    const InboxExcerpt excerpt = node.desk.read({}, kInbox, after);
    came += excerpt.messages.size();
    CHECK(excerpt.messages.size() <= 2);
    after = excerpt.next;
    more = excerpt.more;
  }
  CHECK(came == 5);
}

TEST_CASE("messages to one node are refused when too many wait, those to all replace the oldest") {
  Desk node;
  CHECK_FALSE(node.desk.send({}, message_of("to us", kSelf)).has_value());
  for (std::size_t i = 0; i < MessageDesk::kWaitingMax; ++i) {
    REQUIRE(node.desk.send({}, message_of("wait", kOther)).has_value());
  }
  const auto refused = node.desk.send({}, message_of("one more", kOther));
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().find("1024 messages wait") != std::string::npos);
  const std::size_t waiting = node.book.own()->log.items().size();
  for (std::size_t i = 0; i < MessageDesk::kToAllMax + 50; ++i) {
    REQUIRE(node.desk.send({}, message_of("to all", std::nullopt)).has_value());
  }
  CHECK(node.book.own()->log.items().size() == waiting + MessageDesk::kToAllMax);
  // The receipt of the other makes room.
  mesh::ByteRanges taken;
  taken.add({0, 10});
  node.book.add({}, {kOtherLog, 0, replication::item_of(replication::ReceiptItem{kOwnLog, taken})});
  CHECK(node.desk.send({}, message_of("one more", kOther)).has_value());
}

TEST_CASE("of one key and receiver only the latest message counts") {
  Desk node;
  for (const MemberId to : {kOther, MemberId{3}}) {
    for (const char* const text : {"left", "right"}) {
      Message goal = message_of(text, to);
      goal.key = "goal";
      REQUIRE(node.desk.send({}, goal).has_value());
    }
  }
  REQUIRE(node.book.own()->log.items().size() == 2);
  for (const auto& [number, item] : node.book.own()->log.items()) {
    CHECK(read_message(item)->bytes == message_of("right").bytes);
  }
}

TEST_CASE("what nobody fetched comes again after a restart, what was fetched does not") {
  std::vector<replication::StoredLog> stored;
  {
    Desk node;
    node.receive(0, message_of("one"));
    node.receive(1, message_of("two"));
    const InboxExcerpt excerpt = node.desk.read({}, 0, 0);
    node.desk.read({}, kInbox, excerpt.messages[0].number);
    const LogBook& book = node.book;
    for (const auto& held : book.logs()) {
      stored.push_back({held->log.id(), held->own, held->log.voided(), held->log.seen(), {}});
      for (const auto& [number, item] : held->log.items()) stored.back().items[number] = item;
    }
  }
  LogBook book(kSelf, 8);
  REQUIRE(book.restore({}, stored));
  MessageDesk desk(kSelf, kInbox + 1, book);
  while (const auto arrived = book.poll_arrived()) {
    desk.take_in(arrived->log, arrived->number, arrived->item);
  }
  const InboxExcerpt excerpt = desk.read({}, kInbox, 2);
  REQUIRE(excerpt.messages.size() == 1);
  CHECK(text_of(excerpt.messages[0]) == "two");
}

}  // namespace warren
