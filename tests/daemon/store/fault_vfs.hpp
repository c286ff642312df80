// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <sqlite3.h>

namespace warren::test {

// A disk in memory that fails as disks do, as a file system of SQLite. What is written is seen by
// reads at once, and survives a power cut once it is synced; of the rest any sectors may.
class FaultVfs {
 public:
  explicit FaultVfs(std::uint32_t seed);
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  const char* name() const { return name_.c_str(); }

  // After so many writes, syncs and truncations nothing works any more.
  void power_off_after(std::uint64_t changes) { off_at_ = changes_ + changes; }
  bool is_off() const { return changes_ >= off_at_; }
  // The power comes back; of what was not synced a random part is there. All files must be closed.
  void power_on();

  // Writes beyond this many bytes, of all files, find the disk full.
  void set_capacity(std::uint64_t bytes) { capacity_ = bytes; }
  // One change in so many fails, a sync among them loses a part of what it should have kept; 0:
  // none.
  void fail_one_in(std::uint32_t changes) { fail_one_in_ = changes; }
  // Says that it has synced, and has not.
  void lie(bool lies) { lies_ = lies; }

  std::uint64_t changes() const { return changes_; }
  std::uint64_t syncs() const { return syncs_; }
  std::uint64_t bytes() const;

 private:
  static constexpr std::size_t kSectorBytes = 512;
  using Bytes = std::vector<std::uint8_t>;

  struct Change {
    std::size_t offset = 0;
    Bytes bytes;  // empty: a truncation to the offset
  };
  struct File {
    Bytes seen;                    // by reads
    Bytes durable;                 // what a power cut leaves for sure
    std::vector<Change> unsynced;  // between the two
    bool was_synced = false;
  };
  struct Handle {  // what SQLite holds of an open file
    sqlite3_file base;
    FaultVfs* vfs;
    File* file;
    bool temporary;
  };
  struct Calls;  // SQLite's, into this

  // SQLITE_OK if a change may happen now.
  int change();
  int write(File& file, const void* from, std::size_t bytes, std::size_t offset);
  int sync(File& file);
  int truncate(File& file, std::size_t size);
  void keep_some(File& file, std::uint32_t percent);
  static void apply(const Change& change, Bytes& to);

  std::string name_;
  sqlite3_vfs vfs_{};
  std::mt19937 random_;
  std::map<std::string, std::unique_ptr<File>> files_;
  std::vector<std::unique_ptr<File>> temporary_;
  // A test may change these while another thread writes.
  std::atomic<std::uint64_t> changes_{0};
  std::uint64_t syncs_ = 0;
  std::atomic<std::uint64_t> off_at_{~std::uint64_t{0}};
  std::atomic<std::uint64_t> capacity_{~std::uint64_t{0}};
  std::uint32_t fail_one_in_ = 0;
  bool lies_ = false;
};

}  // namespace warren::test
