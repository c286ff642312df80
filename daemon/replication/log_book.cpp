// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/log_book.hpp"

#include <algorithm>
#include <utility>

#include "daemon/replication/number_ranges.hpp"

namespace warren::replication {
namespace {

// A message waits for an application; anything else is taken as it is stored.
void note_for_us(HeldLog& held, ItemNumber number, const Item& item, bool& taken) {
  if (is_message(item)) {
    held.untaken.add({number, number + 1ULL});
  } else {
    taken = true;
  }
}

// Those that count no more need no receipt.
void forget_void(HeldLog& held) {
  mesh::ByteRanges waiting;
  for (const mesh::NumberRange& range : held.untaken.ranges()) {
    for (std::uint64_t number = range.first; number < range.end; ++number) {
      if (held.log.find(static_cast<ItemNumber>(number)) != nullptr) {
        waiting.add({number, number + 1});
      }
    }
  }
  held.untaken = waiting;
}

}  // namespace

HeldLog& LogBook::insert(const LogId& id, bool own) {
  logs_.push_back(std::make_unique<HeldLog>(id, own));
  HeldLog& held = *logs_.back();
  held.slot = static_cast<Slot>(logs_.size() - 1);
  by_id_[id] = &held;
  return held;
}

HeldLog* LogBook::find(const LogId& id) {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

HeldLog* LogBook::find_or_admit(const LogId& id) {
  if (HeldLog* const held = find(id)) return held;
  if (logs_.size() >= logs_max_) {
    ++logs_refused_;
    return nullptr;
  }
  return &insert(id, false);
}

bool LogBook::open(const LogId& id) {
  if (own_ != nullptr || find(id) != nullptr || logs_.size() >= logs_max_) return false;
  own_ = &insert(id, true);
  return true;
}

bool LogBook::restore_one(const StoredLog& stored) {
  if (find(stored.id) != nullptr || logs_.size() >= logs_max_) return false;
  HeldLog& held = insert(stored.id, stored.own);
  if (stored.own) own_ = &held;
  held.log.make_void(stored.voided);
  for (const auto& [number, item] : stored.items) {
    if (item) held.log.add(number, *item);
  }
  held.log.note_dropped(stored.seen);
  held.stored = held.log.tellable();
  return true;
}

bool LogBook::restore(MeshTime now, std::span<const StoredLog> stored) {
  bool all = true;
  for (const StoredLog& log : stored) all = restore_one(log) && all;
  for (const StoredLog& log : stored) {
    for (const auto& [number, item] : log.items) {
      if (item) apply_receipt(log.id, *item);
    }
  }
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    HeldLog& held = *logs_[i];
    (void)held.log.take_changed();
    bool for_us = false;
    for (const auto& [number, item] : held.log.items()) {
      if (!is_for_us(item)) continue;
      note_for_us(held, number, item, for_us);
      arrived_.push_back({held.log.id(), number, item});
    }
    if (for_us && own_ != nullptr) write_receipt(now, held);
  }
  return all;
}

void LogBook::note_change(MeshTime now, HeldLog& held) {
  held.changed = now;
  ++held.version;
}

std::optional<ItemNumber> LogBook::append(MeshTime now, Item item) {
  std::vector<Item> items;
  items.push_back(std::move(item));
  const auto numbers = append_all(now, std::move(items));
  if (!numbers) return std::nullopt;
  return static_cast<ItemNumber>(numbers->first);
}

std::optional<mesh::NumberRange> LogBook::append_all(MeshTime now, std::vector<Item> items) {
  const bool too_long = std::any_of(items.begin(), items.end(), [](const Item& item) {
    return item.bytes.size() > Item::kBytesMax;
  });
  if (own_ == nullptr || too_long) return std::nullopt;
  if (!own_->log.has_room_for(items)) {
    items_refused_ += items.size();
    return std::nullopt;
  }
  const mesh::NumberRange numbers{own_->log.next_number(), own_->log.next_number() + items.size()};
  for (Item& item : items) own_->log.add(own_->log.next_number(), std::move(item));
  note_change(now, *own_);
  return numbers;
}

// A receipt makes void what it is for, wherever that is held.
void LogBook::apply_receipt(const LogId& writer, const Item& item) {
  const auto receipt = read_receipt(item);
  if (!receipt) return;
  if (HeldLog* const held = find_or_admit(receipt->log)) {
    held->log.on_receipt(MemberId{writer.origin}, receipt->taken);
    ++held->version;
  }
}

void LogBook::add(MeshTime now, ItemParcel parcel) {
  HeldLog* const held = find_or_admit(parcel.log);
  if (held == nullptr || held->own) return;
  const Item copy = parcel.item;
  const AddResult result = held->log.add(parcel.number, std::move(parcel.item));
  if (result == AddResult::kKnown) return;
  note_change(now, *held);
  if (result != AddResult::kAdded) return;
  fresh_[held->slot].push_back(parcel.number);
  apply_receipt(parcel.log, copy);
}

void LogBook::make_void(MeshTime now, const VoidParcel& parcel) {
  HeldLog* const held = find_or_admit(parcel.log);
  if (held == nullptr || held->own) return;
  held->log.make_void(parcel.numbers);
  note_change(now, *held);
}

void LogBook::withdraw(MeshTime now, const mesh::ByteRanges& numbers) {
  if (own_ == nullptr || numbers.empty()) return;
  own_->log.make_void(numbers);
  note_change(now, *own_);
}

void LogBook::take(MeshTime now, const LogId& log, const mesh::ByteRanges& numbers) {
  HeldLog* const held = find(log);
  if (held == nullptr) return;
  for (const mesh::NumberRange& range : numbers.ranges()) held->untaken.remove(range);
  write_receipt(now, *held);
}

bool LogBook::has_unstored() const {
  for (const auto& held : logs_) {
    if (held->log.has_changed()) return true;
  }
  return false;
}

std::vector<StoredLog> LogBook::take_batch(std::uint64_t batch) {
  std::vector<StoredLog> stored;
  for (const auto& held : logs_) {
    if (!held->log.has_changed()) continue;
    stored.push_back({held->log.id(), held->own, held->log.voided(), held->log.seen(), {}});
    std::set<ItemNumber> changed = held->log.take_changed();
    for (const ItemNumber number : changed) {
      const Item* const item = held->log.find(number);
      stored.back().items[number] = item == nullptr ? std::nullopt : std::optional<Item>(*item);
    }
    batched_.push_back({batch, held->slot, std::move(changed), held->log.tellable(),
                        std::exchange(fresh_[held->slot], {})});
  }
  return stored;
}

bool LogBook::on_stored(MeshTime now, std::uint64_t batch) {
  bool moved = false;
  while (!batched_.empty() && batched_.front().batch <= batch) {
    const Batched stored = std::move(batched_.front());
    batched_.pop_front();
    HeldLog& held = *logs_[stored.slot];
    held.stored = stored.tellable;
    ++held.version;
    bool for_us = false;
    for (const ItemNumber number : stored.arrived) {
      const Item* const item = held.log.find(number);
      if (item == nullptr) continue;
      if (is_for_us(*item)) note_for_us(held, number, *item, for_us);
      arrived_.push_back({held.log.id(), number, *item});
    }
    if (for_us) write_receipt(now, held);
    moved = true;
  }
  return moved;
}

void LogBook::on_refused(std::uint64_t batch) {
  for (auto batched = batched_.begin(); batched != batched_.end();) {
    if (batched->batch != batch) {
      ++batched;
      continue;
    }
    std::vector<ItemNumber>& fresh = fresh_[batched->slot];
    fresh.insert(fresh.begin(), batched->arrived.begin(), batched->arrived.end());
    logs_[batched->slot]->log.change(batched->changed);
    batched = batched_.erase(batched);
  }
}

void LogBook::write_receipt(MeshTime now, HeldLog& held) {
  forget_void(held);
  const ReceiptItem receipt{held.log.id(), beyond(held.stored, held.untaken)};
  if (append(now, item_of(receipt))) apply_receipt(own_->log.id(), item_of(receipt));
}

std::optional<ArrivedItem> LogBook::poll_arrived() {
  if (arrived_.empty()) return std::nullopt;
  std::optional<ArrivedItem> arrived(std::move(arrived_.front()));
  arrived_.pop_front();
  return arrived;
}

std::size_t LogBook::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto& held : logs_) bytes += sizeof(HeldLog) + held->log.memory_bytes();
  return bytes;
}

}  // namespace warren::replication
