// SPDX-License-Identifier: Apache-2.0
// The provider's side of logs.
#include <utility>

#include "daemon/replication/log_exchange.hpp"
#include "daemon/replication/number_ranges.hpp"

namespace warren::replication {

void LogExchange::send(MemberId id, Peer& peer, UnderWay what, mesh::ParcelClass priority,
                       std::vector<std::uint8_t> bytes) {
  what.bytes = bytes.size();
  peer.under_way_bytes += what.bytes;
  add_all(peer.subscriptions[what.slot].sent, what.numbers);
  peer.handed_over[++parcels_] = std::move(what);
  commands_.emplace_back(SendParcel{id, priority, std::move(bytes), parcels_});
}

// One parcel of this log, if it has one for the member: the lowest item, else what is void.
bool LogExchange::serve_log(MemberId id, Peer& peer, Slot slot, bool first_class) {
  const HeldLog& held = *book_.at(slot);
  const mesh::ByteRanges missing = beyond(held.stored, peer.subscriptions[slot].sent);
  const auto& items = held.log.items();
  for (const mesh::NumberRange& range : missing.ranges()) {
    auto next = items.lower_bound(static_cast<ItemNumber>(range.first));
    for (; next != items.end() && next->first < range.end; ++next) {
      const auto& [number, item] = *next;
      if (first_class != (class_of(item.kind) == mesh::ParcelClass::kControl)) continue;
      UnderWay what{slot, {}, 0};
      what.numbers.add({number, number + 1ULL});
      send(id, peer, std::move(what), class_of(item.kind),
           encode(ItemParcel{held.log.id(), number, item}));
      return true;
    }
  }
  if (first_class) return false;
  mesh::ByteRanges voided;
  const mesh::ByteRanges all = beyond(missing, beyond(missing, held.log.voided()));
  for (const mesh::NumberRange& range : all.ranges()) {
    if (voided.ranges().size() < kRangesMax) voided.add(range);
  }
  if (voided.empty()) return false;
  auto bytes = encode(VoidParcel{held.log.id(), voided});
  send(id, peer, UnderWay{slot, std::move(voided), 0}, mesh::ParcelClass::kMessage,
       std::move(bytes));
  return true;
}

bool LogExchange::serve_one(MemberId id, Peer& peer, bool first_class) {
  const auto begin = peer.subscriptions.upper_bound(peer.last_served);
  std::vector<Slot> turns;
  for (auto next = begin; next != peer.subscriptions.end(); ++next) turns.push_back(next->first);
  for (auto next = peer.subscriptions.begin(); next != begin; ++next) turns.push_back(next->first);
  for (const Slot slot : turns) {
    if (!peer.subscriptions[slot].wanted || !serve_log(id, peer, slot, first_class)) continue;
    peer.last_served = slot;
    return true;
  }
  return false;
}

void LogExchange::serve(MemberId id, Peer& peer) {
  while (peer.up && peer.under_way.size() + peer.handed_over.size() < kParcelsUnderWayMax &&
         peer.under_way_bytes < kBytesUnderWayMax) {
    if (!serve_one(id, peer, true) && !serve_one(id, peer, false)) return;
  }
}

}  // namespace warren::replication
