// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <tl/expected.hpp>

#include "daemon/store/store_error.hpp"

namespace warren {

// Closes a file at its end.
class FileHandle {
 public:
  explicit FileHandle(int descriptor = -1) : descriptor_(descriptor) {}
  ~FileHandle();
  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) noexcept;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

// The store's file is this process's alone as long as the lock lives: a lock of the kernel on the
// file NAME-lock, gone with the process however that ends, so that none is ever stale. The error
// names the process that has it.
tl::expected<FileHandle, StoreFailure> lock_store(const std::filesystem::path& file);

// Which commit was the last, in the file NAME-commits, written after each commit but never synced.
// It survives a kill, and a power cut only makes it older, so it is never ahead of a sound store:
// if it is, the store has lost commits that were acknowledged (a damaged log, an old copy put
// back).
class CommitMark {
 public:
  explicit CommitMark(const std::filesystem::path& file);
  // Of this store; nothing if it was never noted, or cannot be read.
  std::optional<std::uint64_t> last(std::uint64_t store) const;
  void note(std::uint64_t store, std::uint64_t commit);

 private:
  FileHandle handle_;
};

// Copies of damaged files that are kept; the last makes way for another.
inline constexpr int kCorruptCopiesMax = 2;
// Renames the store's files to NAME.corrupt-N; the first of the new names.
tl::expected<std::filesystem::path, StoreFailure> set_aside(const std::filesystem::path& file);

// Names in the file's folder survive a power cut from here on.
void sync_folder_of(const std::filesystem::path& file);
// Of the write-ahead log beside the file; 0 if there is none.
std::uint64_t log_bytes(const std::filesystem::path& file);

}  // namespace warren
