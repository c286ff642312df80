// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_files.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/exchange/byte_fields.hpp"
#include "daemon/store/sealed_bytes.hpp"

namespace warren {
namespace {

std::filesystem::path beside(const std::filesystem::path& file, const std::string& ending) {
  return file.string() + ending;
}

constexpr std::size_t kMarkBytes = 16 + kSealBytes;
constexpr std::int64_t kMarkKey = 0;

std::string holder_of(int lock) {
  std::array<char, 16> text{};
  const ssize_t read = pread(lock, text.data(), text.size() - 1, 0);
  return read > 0 ? " (" + std::string(text.data()) + ")" : std::string();
}

}  // namespace

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) close(descriptor_);
}
FileHandle::FileHandle(FileHandle&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}
FileHandle& FileHandle::operator=(FileHandle&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

tl::expected<FileHandle, StoreFailure> lock_store(const std::filesystem::path& file) {
  const std::filesystem::path path = beside(file, "-lock");
  FileHandle lock(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (lock.descriptor() < 0) {
    return tl::unexpected(
        StoreFailure{StoreError::kIo, path.string() + ": " + std::strerror(errno)});
  }
  if (flock(lock.descriptor(), LOCK_EX | LOCK_NB) != 0) {
    return tl::unexpected(StoreFailure{
        StoreError::kInUse, file.string() + " is in use by another process" +
                                holder_of(lock.descriptor()) + "; only one may have it open"});
  }
  const std::string holder = "pid " + std::to_string(getpid());
  // For the message above alone: if it cannot be written, that names nobody.
  [[maybe_unused]] const bool named =
      ftruncate(lock.descriptor(), 0) == 0 &&
      pwrite(lock.descriptor(), holder.data(), holder.size(), 0) > 0;
  return lock;
}

CommitMark::CommitMark(const std::filesystem::path& file)
    : handle_(open(beside(file, "-commits").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {}

std::optional<std::uint64_t> CommitMark::last(std::uint64_t store) const {
  std::array<std::uint8_t, kMarkBytes> bytes{};
  const ssize_t read = pread(handle_.descriptor(), bytes.data(), bytes.size(), 0);
  if (read != static_cast<ssize_t>(bytes.size())) return std::nullopt;
  const auto content = unsealed(kMarkKey, bytes);
  if (!content) return std::nullopt;
  ByteReader reader(*content);
  if (reader.number<std::uint64_t>() != store) return std::nullopt;
  return reader.number<std::uint64_t>();
}

void CommitMark::note(std::uint64_t store, std::uint64_t commit) {
  ByteWriter writer;
  writer.add(store);
  writer.add(commit);
  std::vector<std::uint8_t> bytes = writer.take();
  seal(kMarkKey, bytes);
  // Without it one check fewer is made at the next start.
  [[maybe_unused]] const bool noted =
      pwrite(handle_.descriptor(), bytes.data(), bytes.size(), 0) > 0;
}

tl::expected<std::filesystem::path, StoreFailure> set_aside(const std::filesystem::path& file) {
  int number = 1;
  std::filesystem::path kept;
  for (; number <= kCorruptCopiesMax; ++number) {
    kept = beside(file, ".corrupt-" + std::to_string(number));
    if (!std::filesystem::exists(kept)) break;
  }
  for (const char* const ending : {"-wal", "-shm", "-journal", ""}) {
    const std::filesystem::path from = beside(file, ending);
    std::error_code failed;
    if (!std::filesystem::exists(from, failed)) continue;
    std::filesystem::rename(from, beside(kept, ending), failed);
    if (failed) {
      return tl::unexpected(StoreFailure{
          StoreError::kIo, "cannot set " + from.string() + " aside: " + failed.message()});
    }
  }
  sync_folder_of(file);
  return kept;
}

void sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const FileHandle handle(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (handle.descriptor() >= 0) fsync(handle.descriptor());
}

std::uint64_t log_bytes(const std::filesystem::path& file) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(beside(file, "-wal"), failed);
  return failed ? 0 : bytes;
}

}  // namespace warren
