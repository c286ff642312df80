// SPDX-License-Identifier: Apache-2.0
#pragma once

// The node's store: one SQLite file with all that must survive a restart. Who calls what, when:
//
// 1. At start, before anything else runs: Store::open(). A failure with kInUse, kNewerVersion or
//    kNotAStore ends the daemon with the failure's text; the operator must act. Any other failure
//    (no such folder, disk unreadable) is the operator's too. A damaged file is no failure: it is
//    moved aside, a fresh one begun, and the StartReport says so; log it as an error.
// 2. Then take everything out: self_layers() and self_map(), layers() and replica(), items(),
//    counters(), states(). Of a layer that is `closed`, and if the report says `rolled_back` of
//    the own log and of every other numbering too, nothing may be continued: open a new layer
//    number and draw a new incarnation.
//    The self-map's owner hands over all its blocks at the first tick (hand-over cursor 0): what
//    the publisher holds back is not stored, it follows from comparing map and published layer.
// 3. The store then moves into a StoreWorker (store_worker.hpp), which commits batches.
// 4. Commit before it leaves: at a tick the fleet thread publishes, submits a batch with the tick's
//    LayerWrite (write_of() with the claim {all keys, before, now}), the SelfLayerWrite of the
//    same hand-over, counters; and lets transport and replication tell of that revision only when
//    the callback says kStored. Likewise a message is accepted, and a receipt sent, after its
//    batch is stored. One tick is under way at a time: if its callback stays out because the disk
//    refuses, the next tick waits, the map goes on growing, and what changed goes into one batch.
// 5. What packets brought into copies is collected per tick: the claims of all packets that
//    Replica::apply() took, through write_of(); forget()s in `forgotten`. Nobody waits for these.
//
// At the ceiling (disk_bytes_max), and when the disk is full, these go, in this order: items of
// others that their destination has, oldest first; copies of others' layers, longest unchanged
// first, each whole (it is not stored again before the next start, and then caught up from peers);
// items of others that are under way, oldest first. Own layers, self-map, own items, counters and
// states never go: when nothing else is left, commits fail and are tried again, and StoreHealth
// says so.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/store/store_batch.hpp"
#include "daemon/store/store_error.hpp"
#include "daemon/store/store_result.hpp"

namespace warren {

struct StoreConfig {
  std::filesystem::path file;  // in an existing folder
  // Of the file, and of its log up to kLogsMax checkpoints. At least 32 checkpoints.
  std::uint64_t disk_bytes_max = std::uint64_t{4} << 30;
  std::uint64_t checkpoint_bytes = std::uint64_t{4} << 20;  // of log, before it goes into the file
  std::uint64_t cache_bytes = std::uint64_t{8} << 20;       // memory for pages
  const char* vfs = nullptr;  // SQLite's name for the file system to use; tests have their own
};

// What a start found, for the log: everything here but the numbers is worth a line.
struct StartReport {
  bool fresh = false;      // nothing was there, or it was moved aside
  bool recovered = false;  // the process before did not end cleanly; its log was read
  struct MovedAside {
    std::filesystem::path to;
    std::string why;
  };
  std::optional<MovedAside> moved_aside;
  bool rolled_back = false;  // commits that were acknowledged are gone: own layers are closed
  std::uint64_t commits_lost = 0;
  std::size_t layers = 0;
  std::size_t self_layers = 0;
  std::size_t blocks = 0;  // of both
  std::size_t items = 0;
  std::uint64_t bytes = 0;
  double seconds = 0.0;  // to open and to check everything
};

struct StoredLayer {
  LayerHead head;
  bool closed = false;  // an own layer that must not be continued; it may be written as a copy
};

struct StoreUsage {
  std::uint64_t file_bytes = 0;
  std::uint64_t used_bytes = 0;  // of these; the rest waits to be used again
  std::uint64_t log_bytes = 0;
  std::uint64_t commits = 0;  // since the store was made
  std::uint64_t checkpoints_failed = 0;
};

// Opens, checks, reads and writes the file. One thread at a time; no clock but for the report.
// Promises: a batch that commit() reported as stored is there after a kill or a power cut at any
// later instant, whole; one that it did not is there whole or not at all.
class Store {
 public:
  static constexpr std::uint64_t kLogsMax = 8;

  struct Opened;
  static tl::expected<Opened, StoreFailure> open(const StoreConfig& config);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  // Everything below until the first commit cannot be damaged, it was checked; but a disk can fail
  // any time.
  std::vector<StoredLayer> layers() const;
  tl::expected<Replica, StoreFailure> replica(const LayerHead& head);
  std::vector<SelfLayerHead> self_layers() const;
  tl::expected<SelfMap, StoreFailure> self_map(const SelfLayerHead& head);
  tl::expected<std::vector<LogItem>, StoreFailure> items();  // in the order they were stored
  tl::expected<std::map<std::string, std::uint64_t>, StoreFailure> counters();
  tl::expected<std::map<std::string, std::vector<std::uint8_t>>, StoreFailure> states();

  // All of them in one transaction. A failure leaves the file as it was; the same batches may be
  // tried again.
  tl::expected<CommitReport, StoreFailure> commit(std::span<const StoreBatch* const> batches);

  StoreUsage usage();

  struct State;

 private:
  explicit Store(std::unique_ptr<State> state);
  static tl::expected<Opened, StoreFailure> open_once(const StoreConfig& config);

  std::unique_ptr<State> state_;
};

struct Store::Opened {
  Store store;
  StartReport report;
};

}  // namespace warren
