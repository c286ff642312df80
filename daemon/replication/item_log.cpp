// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/item_log.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace warren::replication {
namespace {

constexpr std::size_t kItemOverhead = 128;

std::size_t charge(const Item& item) {
  return item.bytes.size() + item.name.size() + kItemOverhead;
}

std::string name_of(const Item& item) { return {item.name.begin(), item.name.end()}; }

}  // namespace

ItemNumber ItemLog::next_number() const {
  return seen_.empty() ? 0 : static_cast<ItemNumber>(seen_.ranges().back().end);
}

bool ItemLog::has_room_for(std::span<const Item> items) const {
  std::size_t bytes = bytes_;
  for (const Item& item : items) bytes += charge(item);
  return items_.size() + items.size() <= kItemsMax && bytes <= kBytesMax;
}

const Item* ItemLog::find(ItemNumber number) const {
  const auto found = items_.find(number);
  return found == items_.end() ? nullptr : &found->second;
}

void ItemLog::erase(ItemNumber number) {
  const auto found = items_.find(number);
  if (found == items_.end()) return;
  bytes_ -= charge(found->second);
  const auto latest = latest_.find(name_of(found->second));
  if (latest != latest_.end() && latest->second == number) latest_.erase(latest);
  items_.erase(found);
}

void ItemLog::void_one(ItemNumber number) {
  if (voided_.contains(number)) return;
  erase(number);
  seen_.add({number, number + 1ULL});
  voided_.add({number, number + 1ULL});
  tellable_.add({number, number + 1ULL});
  changed_.insert(number);
}

bool ItemLog::drop_oldest(bool only_trajectories) {
  const auto oldest = std::find_if(items_.begin(), items_.end(), [&](const auto& entry) {
    const ItemKind kind = entry.second.kind;
    return only_trajectories ? kind == ItemKind::kTrajectory : kind != ItemKind::kCommand;
  });
  if (oldest == items_.end()) return false;
  const ItemNumber number = oldest->first;
  erase(number);
  tellable_.remove({number, number + 1ULL});
  changed_.insert(number);
  ++dropped_;
  return true;
}

bool ItemLog::make_room(const Item& item) {
  while (!has_room_for(item)) {
    if (own_) return false;
    if (!drop_oldest(true) && !drop_oldest(false)) return false;
  }
  return true;
}

AddResult ItemLog::add(ItemNumber number, Item item) {
  if (seen_.contains(number)) return AddResult::kKnown;
  const auto taken = item.to ? taken_.find(*item.to) : taken_.end();
  if (taken != taken_.end() && taken->second.contains(number)) {
    void_one(number);
    return AddResult::kReplaced;
  }
  const auto latest = item.name.empty() ? latest_.end() : latest_.find(name_of(item));
  if (latest != latest_.end()) {
    const ItemNumber other = latest->second;
    void_one(std::min(other, number));
    if (other > number) return AddResult::kReplaced;
  }
  const bool room = make_room(item);
  assert(room || !own_);
  seen_.add({number, number + 1ULL});
  changed_.insert(number);
  if (!room) {
    ++dropped_;
    return AddResult::kNoRoom;
  }
  tellable_.add({number, number + 1ULL});
  bytes_ += charge(item);
  if (!item.name.empty()) latest_[name_of(item)] = number;
  items_.emplace(number, std::move(item));
  return AddResult::kAdded;
}

void ItemLog::make_void(const mesh::ByteRanges& numbers) {
  for (const mesh::NumberRange& range : numbers.ranges()) {
    // What was held takes its bytes along; the rest is said in one.
    for (auto held = items_.lower_bound(static_cast<ItemNumber>(range.first));
         held != items_.end() && held->first < range.end;) {
      const ItemNumber number = held->first;
      ++held;
      void_one(number);
    }
    if (voided_.contains(range)) continue;
    changed_.insert(static_cast<ItemNumber>(range.first));
    seen_.add(range);
    voided_.add(range);
    tellable_.add(range);
  }
}

void ItemLog::note_dropped(const mesh::ByteRanges& seen) {
  for (const mesh::NumberRange& range : seen.ranges()) seen_.add(range);
}

void ItemLog::on_receipt(MemberId from, const mesh::ByteRanges& taken) {
  mesh::ByteRanges& known = taken_[from];
  for (const mesh::NumberRange& range : taken.ranges()) known.add(range);
  std::vector<ItemNumber> done;
  for (const auto& [number, item] : items_) {
    if (item.to == from && known.contains(number)) done.push_back(number);
  }
  for (const ItemNumber number : done) void_one(number);
}

std::set<ItemNumber> ItemLog::take_changed() { return std::exchange(changed_, {}); }

std::size_t ItemLog::memory_bytes() const {
  return sizeof(*this) + bytes_ + changed_.size() * 40 +
         (seen_.ranges().size() + voided_.ranges().size() + tellable_.ranges().size()) * 16;
}

}  // namespace warren::replication
