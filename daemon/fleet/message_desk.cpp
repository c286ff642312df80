// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/message_desk.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace warren {
namespace {

using replication::Item;
using replication::ItemNumber;
using replication::LogId;

constexpr std::size_t kOverhead = 128;  // of a message in the inbox

std::size_t charge(const InboxMessage& held) { return held.message.bytes.size() + kOverhead; }

}  // namespace

void MessageDesk::Waiting::add(const Item& item) {
  ++count;
  bytes += item.bytes.size();
}

MessageDesk::Waiting MessageDesk::waiting_for_receipt() const {
  Waiting waiting;
  for (const auto& [number, item] : book_.own()->log.items()) {
    if (replication::is_message(item) && item.to) waiting.add(item);
  }
  return waiting;
}

// Makes room for one more to everybody: nobody can tell when the last of the fleet has it.
void MessageDesk::withdraw_old(MeshTime now, const Item& next) {
  std::vector<std::pair<ItemNumber, std::size_t>> to_all;  // oldest first
  Waiting kept;
  kept.add(next);
  for (const auto& [number, item] : book_.own()->log.items()) {
    if (!replication::is_message(item) || item.to) continue;
    to_all.emplace_back(number, item.bytes.size());
    kept.add(item);
  }
  mesh::ByteRanges old;
  for (const auto& [number, bytes] : to_all) {
    if (kept.count <= kToAllMax && kept.bytes <= kToAllBytesMax) break;
    --kept.count;
    kept.bytes -= bytes;
    old.add({number, number + 1ULL});
  }
  book_.withdraw(now, old);
}

tl::expected<ItemNumber, std::string> MessageDesk::send(MeshTime now, const Message& message) {
  if (book_.own() == nullptr) return tl::unexpected(std::string("the mesh has not started yet"));
  if (message.to == self_) return tl::unexpected(std::string("that is this node itself"));
  Item item = item_of(message);
  if (message.to) {
    const Waiting waiting = waiting_for_receipt();
    if (waiting.count >= kWaitingMax || waiting.bytes + item.bytes.size() > kWaitingBytesMax) {
      return tl::unexpected(std::to_string(waiting.count) +
                            " messages wait for their receivers to fetch them; try again later");
    }
  } else {
    withdraw_old(now, item);
  }
  const auto number = book_.append(now, std::move(item));
  if (!number) return tl::unexpected(std::string("this node's log is full"));
  return *number;
}

void MessageDesk::take_in(const LogId& log, ItemNumber number, const Item& item) {
  if (!replication::is_message(item) || log.origin == self_.number) return;
  if (item.to && *item.to != self_) return;
  auto message = read_message(item);
  if (!message) {
    ++unreadable_;
    return;
  }
  inbox_.push_back({++last_, MemberId{log.origin}, log, number, std::move(*message)});
  inbox_bytes_ += charge(inbox_.back());
  make_room();
}

void MessageDesk::make_room() {
  while (inbox_.size() > kInboxMax || inbox_bytes_ > kInboxBytesMax) {
    if (inbox_.front().number > fetched_) ++dropped_;
    inbox_bytes_ -= charge(inbox_.front());
    inbox_.pop_front();
  }
}

// Those to this node alone get their receipt.
void MessageDesk::note_fetched(MeshTime now, std::uint64_t up_to) {
  if (up_to <= fetched_) return;
  std::map<LogId, mesh::ByteRanges> taken;
  for (const InboxMessage& held : inbox_) {
    if (held.number <= fetched_ || held.number > up_to || !held.message.to) continue;
    taken[held.log].add({held.item, held.item + 1ULL});
  }
  fetched_ = up_to;
  for (const auto& [log, numbers] : taken) book_.take(now, log, numbers);
}

InboxExcerpt MessageDesk::read(MeshTime now, std::uint64_t inbox, std::uint64_t after) {
  if (inbox != inbox_id_) after = 0;
  after = std::min(after, last_);
  note_fetched(now, after);
  InboxExcerpt excerpt;
  excerpt.inbox = inbox_id_;
  const std::uint64_t oldest = inbox_.empty() ? last_ + 1 : inbox_.front().number;
  excerpt.next = std::max(after, oldest - 1);
  if (oldest > after + 1) excerpt.missed = oldest - after - 1;
  std::size_t bytes = 0;
  for (const InboxMessage& held : inbox_) {
    if (held.number <= after) continue;
    bytes += charge(held);
    excerpt.more = !excerpt.messages.empty() && bytes > kExcerptBytesMax;
    if (excerpt.more) break;
    excerpt.messages.push_back(held);
    excerpt.next = held.number;
  }
  return excerpt;
}

}  // namespace warren
