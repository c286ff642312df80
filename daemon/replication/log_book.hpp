// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/replication/item_log.hpp"
#include "daemon/replication/map_message.hpp"
#include "transport/mesh_time.hpp"

namespace warren::replication {

struct HeldLog {
  HeldLog(const LogId& id, bool is_own) : log(id, is_own), own(is_own) {}
  ItemLog log;
  Slot slot = 0;
  bool own = false;
  mesh::ByteRanges stored;   // of what can be told
  mesh::ByteRanges untaken;  // of that, messages to us that no application has fetched
  MeshTime changed = MeshTime::min();
  std::uint64_t version = 0;
};

// What the store has to write of one log.
struct StoredLog {
  LogId id;
  bool own = false;
  mesh::ByteRanges voided;
  mesh::ByteRanges seen;
  std::map<ItemNumber, std::optional<Item>> items;  // none: it goes
};

struct ArrivedItem {
  LogId log;
  ItemNumber number = 0;
  Item item;
};

// The logs this node holds, at most so many.
class LogBook {
 public:
  LogBook(MemberId self, std::size_t logs_max)
      : self_(self), logs_max_(logs_max < kSlotsMax ? logs_max : kSlotsMax) {}

  // The log that this node writes from now on; it begins anew, or goes on as it was restored.
  bool open(const LogId& id);
  // All that the store has, before anything else; false if it is too much.
  bool restore(MeshTime now, std::span<const StoredLog> stored);
  // None if there is no room.
  HeldLog* find_or_admit(const LogId& id);
  HeldLog* find(const LogId& id);
  HeldLog* at(Slot slot) { return slot < logs_.size() ? logs_[slot].get() : nullptr; }
  HeldLog* own() { return own_; }
  const std::vector<std::unique_ptr<HeldLog>>& logs() const { return logs_; }

  // To the own log; nothing if it is not open or full.
  std::optional<ItemNumber> append(MeshTime now, Item item);
  // Likewise, all of them or none: at least one. The numbers they get.
  std::optional<mesh::NumberRange> append_all(MeshTime now, std::vector<Item> items);
  void add(MeshTime now, ItemParcel parcel);
  void make_void(MeshTime now, const VoidParcel& parcel);

  bool has_unstored() const;
  bool all_stored() const { return batched_.empty() && !has_unstored(); }
  std::vector<StoredLog> take_batch(std::uint64_t batch);
  // These of the own log count no more.
  void withdraw(MeshTime now, const mesh::ByteRanges& numbers);
  // An application has fetched these messages: their receipt is written.
  void take(MeshTime now, const LogId& log, const mesh::ByteRanges& numbers);
  // Everything up to this batch is stored; whether that moved anything on. Receipts for what was
  // addressed to us are written then, but for messages.
  bool on_stored(MeshTime now, std::uint64_t batch);
  // Nothing of this batch is stored: the next one says it again.
  void on_refused(std::uint64_t batch);
  // Items of others that are stored, each once; after a restart again those addressed to us that no
  // receipt of ours names.
  std::optional<ArrivedItem> poll_arrived();

  std::uint64_t logs_refused() const { return logs_refused_; }
  std::uint64_t items_refused() const { return items_refused_; }
  std::size_t memory_bytes() const;

 private:
  struct Batched {
    std::uint64_t batch = 0;
    Slot slot = 0;
    std::set<ItemNumber> changed;
    mesh::ByteRanges tellable;
    std::vector<ItemNumber> arrived;
  };
  HeldLog& insert(const LogId& id, bool own);
  bool restore_one(const StoredLog& stored);
  void note_change(MeshTime now, HeldLog& held);
  void apply_receipt(const LogId& writer, const Item& item);
  void write_receipt(MeshTime now, HeldLog& held);
  bool is_for_us(const Item& item) const { return item.to == self_; }

  MemberId self_;
  std::size_t logs_max_;
  std::vector<std::unique_ptr<HeldLog>> logs_;
  std::map<LogId, HeldLog*> by_id_;
  HeldLog* own_ = nullptr;
  std::map<Slot, std::vector<ItemNumber>> fresh_;  // arrived since the last batch
  std::deque<Batched> batched_;
  std::deque<ArrivedItem> arrived_;
  std::uint64_t logs_refused_ = 0;
  std::uint64_t items_refused_ = 0;
};

}  // namespace warren::replication
