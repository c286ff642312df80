// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "daemon/replication/item.hpp"

namespace warren::replication {

enum class AddResult : std::uint8_t {
  kAdded,
  kKnown,     // it is here, or was
  kReplaced,  // a later one of its name, or a receipt for it, is here
  kNoRoom,
};

// The numbered items of one node, as far as they are known here. Each number is in one of four
// states: unknown; held; void, that is, it counts no more, for anybody: a later item of its name or
// its addressee's receipt has come; dropped: it did not fit here. Nothing goes back to unknown.
//
// Bounds: kItemsMax held items and kBytesMax of them. The own log then takes nothing more. Of
// another's log the oldest items go: first thinned trajectories, then what is not a command.
class ItemLog {
 public:
  static constexpr std::size_t kItemsMax = 4096;
  static constexpr std::size_t kBytesMax = 4'000'000;

  ItemLog(const LogId& id, bool own) : id_(id), own_(own) {}

  const LogId& id() const { return id_; }
  // The next number of the own log.
  ItemNumber next_number() const;
  bool has_room_for(std::span<const Item> items) const;
  bool has_room_for(const Item& item) const { return has_room_for(std::span(&item, 1)); }
  // Precondition of an own log: has_room_for(item).
  AddResult add(ItemNumber number, Item item);
  // They count no more.
  void make_void(const mesh::ByteRanges& numbers);
  // Of these numbers, those that are neither held nor void did not fit in an earlier life.
  void note_dropped(const mesh::ByteRanges& seen);
  // The member has taken what is addressed to it out of these.
  void on_receipt(MemberId from, const mesh::ByteRanges& taken);

  const Item* find(ItemNumber number) const;
  const std::map<ItemNumber, Item>& items() const { return items_; }
  const mesh::ByteRanges& voided() const { return voided_; }
  // Held or void: what can be told to others.
  const mesh::ByteRanges& tellable() const { return tellable_; }
  // All that is not unknown.
  const mesh::ByteRanges& seen() const { return seen_; }
  std::uint64_t dropped() const { return dropped_; }
  std::size_t memory_bytes() const;

  // Numbers whose state changed since the last call.
  std::set<ItemNumber> take_changed();
  bool has_changed() const { return !changed_.empty(); }
  // What was taken came nowhere: it counts as changed again.
  void change(const std::set<ItemNumber>& numbers) {
    changed_.insert(numbers.begin(), numbers.end());
  }

 private:
  void erase(ItemNumber number);
  void void_one(ItemNumber number);
  bool make_room(const Item& item);
  bool drop_oldest(bool only_trajectories);

  LogId id_;
  bool own_;
  std::map<ItemNumber, Item> items_;
  std::map<std::string, ItemNumber> latest_;  // by name
  std::map<MemberId, mesh::ByteRanges> taken_;
  mesh::ByteRanges seen_;
  mesh::ByteRanges voided_;
  mesh::ByteRanges tellable_;
  std::set<ItemNumber> changed_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace warren::replication
