// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "daemon/store/schema.hpp"
#include "daemon/store/store_state.hpp"

namespace warren {
namespace {

BatchResult judge(const Store::State& s, const StoreBatch& batch) {
  std::set<LayerId> written;
  for (const LayerWrite& write : batch.layers) {
    if (!written.insert(write.head.id).second) return BatchResult::kUnsound;
    const BatchResult result = s.layers.judge(write);
    if (result != BatchResult::kStored) return result;
  }
  for (const SelfLayerWrite& write : batch.self_layers) {
    const BatchResult result = s.selves.judge(write);
    if (result != BatchResult::kStored) return result;
  }
  const BatchResult items = s.log.judge(batch);
  return items != BatchResult::kStored ? items : s.named.judge(batch);
}

void write(Store::State& s, const StoreBatch& batch, Evictions& evicted) {
  for (const LayerId& id : batch.erased_layers) s.layers.erase(id);
  for (const LayerWrite& write : batch.layers) {
    if (!s.layers.write(write, s.row.commits)) ++evicted.writes_dropped;
  }
  for (const SelfLayerWrite& write : batch.self_layers) s.selves.write(write);
  for (const LogItem& item : batch.items) s.log.put(item, evicted);
  for (const LogReceipt& receipt : batch.receipts) s.log.receive(receipt);
  for (const LogItemId& id : batch.erased_items) s.log.erase(id);
  s.named.write(batch);
}

// Lets one thing go that may; false if there is none.
bool evict_one(Store::State& s, Evictions& evicted) {
  const auto evict_items = [&](bool done_only) {
    const std::vector<LogItemId> items = s.log.evict(done_only, kEvictedAtOnce);
    evicted.items.insert(evicted.items.end(), items.begin(), items.end());
    return !items.empty();
  };
  if (evict_items(true)) return true;
  if (const auto layer = s.layers.evict_one()) {
    evicted.layers.push_back(*layer);
    return true;
  }
  return evict_items(false);
}

// Above nine tenths of the ceiling down to eight; and one thing if there was no room just now.
void make_room(Store::State& s, Evictions& evicted) {
  const std::uint64_t tenth = static_cast<std::uint64_t>(s.pages_max()) * kPageBytes / 10;
  if (!s.needs_room && s.used_bytes() <= 9 * tenth) return;
  bool evicting = evict_one(s, evicted);
  while (evicting && s.database.ok() && s.used_bytes() > 8 * tenth)
    evicting = evict_one(s, evicted);
}

// The log goes into the file from time to time; while that fails it grows, up to a bound.
void checkpoint(Store::State& s) {
  const std::int64_t pages = s.database.log_pages();
  const auto due = static_cast<std::int64_t>(s.config.checkpoint_bytes / kPageBytes);
  if (pages < due) return;
  const auto failure = s.database.checkpoint();
  if (!failure) return;
  ++s.checkpoints_failed;
  if (pages > due * static_cast<std::int64_t>(Store::kLogsMax)) {
    s.database.fail(failure->error, "the log cannot be moved into the file: " + failure->text);
  }
}

StoreFailure failed(Store::State& s, std::span<const StoreBatch* const> batches) {
  StoreFailure failure = *s.database.failure();
  s.database.clear_failure();
  s.database.roll_back();
  s.layers.rolled_back();
  s.must_load = true;
  if (failure.error != StoreError::kDiskFull) return failure;
  s.needs_room = true;
  // A full log may leave no room for the transaction that would make some.
  s.database.checkpoint();
  std::uint64_t wanted = 0;
  for (const StoreBatch* const batch : batches) wanted += batch->memory_bytes();
  const auto ceiling = static_cast<std::uint64_t>(s.pages_max()) * kPageBytes;
  if (s.used_bytes() + 2 * wanted > ceiling) failure.error = StoreError::kCeiling;
  s.database.clear_failure();
  return failure;
}

}  // namespace

tl::expected<CommitReport, StoreFailure> Store::commit(std::span<const StoreBatch* const> batches) {
  State& s = *state_;
  s.database.clear_failure();
  checkpoint(s);
  if (s.must_load) s.load();
  if (!s.database.ok()) return tl::unexpected(failed(s, batches));

  CommitReport report;
  s.database.run("BEGIN IMMEDIATE");
  ++s.row.commits;
  make_room(s, report.evicted);
  for (const StoreBatch* const batch : batches) {
    report.results.push_back(judge(s, *batch));
    if (report.results.back() == BatchResult::kStored) write(s, *batch, report.evicted);
  }
  s.store_rows.put(0, encode_store_row(s.row));
  s.database.run("COMMIT");
  if (!s.database.ok()) return tl::unexpected(failed(s, batches));

  for (const StoreBatch* const batch : batches) s.is_behind = s.is_behind || batch->is_behind;
  s.mark.note(s.row.store, s.row.commits + (s.is_behind ? 1 : 0));
  s.layers.committed();
  s.must_load = false;
  s.needs_room = false;
  return report;
}

}  // namespace warren
