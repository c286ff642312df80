// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/log_exchange.hpp"

#include <algorithm>
#include <utility>

#include "daemon/replication/number_ranges.hpp"

namespace warren::replication {

void LogExchange::on_up(MemberId member, bool up) {
  peers_[member].up = up;
  choose_ = true;
}

void LogExchange::on_restarted(MemberId member) {
  Peer& peer = peers_[member];
  const bool up = peer.up;
  peer = Peer();
  peer.up = up;
  choose_ = true;
  for (auto& [slot, way] : ways_) {
    if (way.provider == member) way = {};
  }
}

void LogExchange::on_forgotten(MemberId member) {
  on_restarted(member);
  peers_.erase(member);
}

void LogExchange::on_announcement(MemberId from, Slot slot, std::span<const std::uint8_t> bytes) {
  auto announcement = read_log_announcement(bytes);
  Peer& peer = peers_[from];
  const auto known = peer.announced.find(slot);
  if (!announcement || (known != peer.announced.end() && known->second.log != announcement->log) ||
      book_.find_or_admit(announcement->log) == nullptr) {
    ++refused_;
    return;
  }
  peer.slots[announcement->log] = slot;
  peer.announced.insert_or_assign(slot, std::move(*announcement));
  choose_ = true;
}

bool LogExchange::on_message(MemberId from, std::span<const std::uint8_t> bytes) {
  const auto wishes = read_log_wishes(bytes);
  if (!wishes) return false;
  Peer& peer = peers_[from];
  for (const LogWish& wish : *wishes) {
    Subscription* const subscription =
        book_.at(wish.slot) == nullptr ? nullptr : &peer.subscriptions[wish.slot];
    if (subscription == nullptr || wish.number <= subscription->number) {
      ++refused_;
      continue;
    }
    subscription->number = wish.number;
    subscription->wanted = wish.wanted;
    add_all(subscription->sent, wish.seen);
  }
  return true;
}

bool LogExchange::on_parcel(MeshTime now, const mesh::ParcelArrived& parcel) {
  if (auto item = read_item_parcel(parcel.bytes)) {
    book_.add(now, std::move(*item));
  } else if (const auto voided = read_void_parcel(parcel.bytes)) {
    book_.make_void(now, *voided);
  } else {
    return false;
  }
  to_finish_.emplace_back(parcel.from, parcel.key);
  finish_if_all_is_stored();
  return true;
}

void LogExchange::finish_if_all_is_stored() {
  if (!book_.all_stored()) return;
  for (const auto& [from, key] : std::exchange(to_finish_, {})) {
    commands_.emplace_back(FinishParcel{from, key});
  }
}

void LogExchange::on_parcel_sent(std::uint64_t number, std::optional<mesh::ParcelKey> key) {
  for (auto& [id, peer] : peers_) {
    const auto found = peer.handed_over.find(number);
    if (found == peer.handed_over.end()) continue;
    if (key) {
      peer.under_way[*key] = std::move(found->second);
    } else {
      for (const mesh::NumberRange& range : found->second.numbers.ranges()) {
        peer.subscriptions[found->second.slot].sent.remove(range);
      }
      peer.under_way_bytes -= found->second.bytes;
    }
    peer.handed_over.erase(found);
    return;
  }
}

void LogExchange::on_parcel_delivered(const mesh::ParcelDelivered& delivered) {
  Peer& peer = peers_[delivered.to];
  const auto found = peer.under_way.find(delivered.key);
  if (found == peer.under_way.end()) return;
  peer.under_way_bytes -= found->second.bytes;
  peer.under_way.erase(found);
}

void LogExchange::on_batch(std::uint64_t batch) {
  for (const auto& [from, key] : std::exchange(to_finish_, {})) {
    finishing_.emplace_back(batch, FinishParcel{from, key});
  }
}

void LogExchange::on_stored(MeshTime now, std::uint64_t batch) {
  book_.on_stored(now, batch);
  while (!finishing_.empty() && finishing_.front().first <= batch) {
    commands_.emplace_back(finishing_.front().second);
    finishing_.pop_front();
  }
  finish_if_all_is_stored();
}

std::vector<Candidate> LogExchange::candidates(const HeldLog& held) const {
  std::vector<Candidate> found;
  const auto way = ways_.find(held.slot);
  for (const auto& [id, peer] : peers_) {
    const auto slot = peer.up ? peer.slots.find(held.log.id()) : peer.slots.end();
    if (slot == peer.slots.end()) continue;
    const LogAnnouncement& announced = peer.announced.at(slot->second);
    found.push_back({.member = id,
                     .hops = announced.hops,
                     .is_origin = id.number == held.log.id().origin && announced.hops == 0,
                     .gets_it_here = announced.provider == config_.self,
                     .leads = !beyond(announced.tellable, held.log.seen()).empty(),
                     .highest = static_cast<std::uint32_t>(
                         std::min<std::uint64_t>(announced.tellable.size(), UINT32_MAX)),
                     .is_current = way != ways_.end() && way->second.provider == id});
  }
  return found;
}

void LogExchange::tell(MemberId member, Slot slot) {
  peers_[member].wishes_due.insert(slot);
  commands_.emplace_back(Wake{member});
}

void LogExchange::choose(const HeldLog& held) {
  Way& way = ways_[held.slot];
  const Choice choice = choose_provider(candidates(held));
  way.hops = choice.hops;
  if (choice.provider == way.provider) return;
  const auto before = std::exchange(way.provider, choice.provider);
  if (before) tell(*before, held.slot);
  if (choice.provider) tell(*choice.provider, held.slot);
}

std::optional<std::vector<std::uint8_t>> LogExchange::next_wishes(MemberId to, std::size_t limit,
                                                                  std::vector<Slot>& told) {
  Peer& peer = peers_[to];
  std::vector<std::uint8_t> message{LogWish::kKind};
  while (!peer.wishes_due.empty()) {
    const Slot slot = *peer.wishes_due.begin();
    const HeldLog& held = *book_.at(slot);
    const auto theirs = peer.slots.find(held.log.id());
    if (theirs != peer.slots.end()) {
      const std::size_t before = message.size();
      LogWish wish{theirs->second, ++wishes_, ways_[slot].provider == to, {}};
      if (wish.wanted) wish.seen = held.log.seen();
      append(message, wish);
      if (message.size() > limit) {
        message.resize(before);
        break;
      }
      told.push_back(slot);
    }
    peer.wishes_due.erase(peer.wishes_due.begin());
  }
  return told.empty() ? std::nullopt : std::optional(std::move(message));
}

void LogExchange::on_wishes_lost(MemberId to, const std::vector<Slot>& told) {
  peers_[to].wishes_due.insert(told.begin(), told.end());
}

Said::Thing LogExchange::thing_of(const HeldLog& held) const {
  const auto way = ways_.find(held.slot);
  if (held.own) return {{0, std::nullopt}, held.version, held.changed};
  return {way == ways_.end() ? Way{} : way->second, held.version, held.changed};
}

void LogExchange::say(const HeldLog& held, Spoken& spoken) {
  const Said::Thing thing = thing_of(held);
  LogAnnouncement announcement{held.log.id(), thing.way.hops, thing.way.provider, held.stored};
  const bool settled =
      held.stored == held.log.tellable() &&
      (held.changed == MeshTime::min() || now_ >= held.changed + config_.timers.quiet);
  spoken.clock.on_said(now_, thing, settled);
  if (spoken.last == announcement) return;
  commands_.emplace_back(
      SetTelemetry{static_cast<std::uint16_t>(kLogKeys + held.slot), encode(announcement)});
  spoken.last = std::move(announcement);
}

void LogExchange::announce() {
  next_said_ = kNever;
  for (const auto& held : book_.logs()) {
    Spoken& spoken = spoken_[held->slot];
    const Said::Thing thing = thing_of(*held);
    const auto due = [&] {
      if (spoken.clock.ever()) return spoken.clock.due(now_, config_.timers, thing);
      return held->stored.empty() && thing.way.hops == kNoWay ? kNever : now_;
    };
    if (due() <= now_) say(*held, spoken);
    next_said_ = std::min(next_said_, due());
  }
}

void LogExchange::advance(MeshTime now) {
  now_ = now;
  if (std::exchange(choose_, false)) {
    for (const auto& held : book_.logs()) {
      if (!held->own) choose(*held);
    }
  }
  for (auto& [id, peer] : peers_) serve(id, peer);
  announce();
}

MeshTime LogExchange::next_deadline() const { return choose_ ? now_ : next_said_; }

const Way* LogExchange::way_of(Slot slot) const {
  const auto found = ways_.find(slot);
  return found == ways_.end() ? nullptr : &found->second;
}

std::size_t LogExchange::memory_bytes() const {
  std::size_t bytes = book_.memory_bytes();
  for (const auto& [id, peer] : peers_) {
    bytes += sizeof(Peer) + peer.announced.size() * 200 + peer.subscriptions.size() * 200 +
             (peer.under_way.size() + peer.handed_over.size()) * 150;
  }
  return bytes;
}

}  // namespace warren::replication
