// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <exception>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace warren {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFileMode = 0666;  // as far as the umask allows

std::string error_text(int error) { return std::generic_category().message(error); }

tl::unexpected<std::string> write_failure(const fs::path& file, const std::string& why) {
  return tl::make_unexpected("cannot write " + file.string() + ": " + why);
}

// A file that no one else writes, beside the final one so that a rename can replace it. Removed at
// the end unless renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& beside) {
    path_ = beside;
    static std::atomic<std::uint32_t> counter{0};
    path_ += ".part-" + std::to_string(::getpid()) + "-" + std::to_string(++counter);
    // A leftover of a process that had our number is nobody's; a symlink is not followed.
    ::unlink(path_.c_str());
    const int fd = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode);
    if (fd < 0) {
      error_ = errno;
    } else {
      ::close(fd);
    }
  }
  ~TemporaryFile() {
    if (error_ == 0 && !path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const fs::path& path() const { return path_; }
  int error() const { return error_; }

  // 0 or an errno.
  int rename_to(const fs::path& file) {
    if (::rename(path_.c_str(), file.c_str()) != 0) return errno;
    path_.clear();
    return 0;
  }

 private:
  fs::path path_;
  int error_ = 0;
};

// 0 or an errno.
int flush_to_disk(const fs::path& path, int flags) {
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
  if (fd < 0) return errno;
  const int error = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  return error;
}

fs::path directory_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

tl::expected<std::uint64_t, std::string> write_atomically(
    const fs::path& file, const std::function<WriteResult(const fs::path& temporary)>& write) {
  TemporaryFile temporary(file);
  if (temporary.error() != 0) return write_failure(file, error_text(temporary.error()));
  try {
    const WriteResult written = write(temporary.path());
    if (!written) return write_failure(file, written.error());
  } catch (const std::exception& thrown) {
    return write_failure(file, thrown.what());
  }
  if (const int error = flush_to_disk(temporary.path(), O_RDONLY); error != 0) {
    return write_failure(file, error_text(error));
  }
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(temporary.path(), error);
  if (error) return write_failure(file, error.message());
  if (const int failed = temporary.rename_to(file); failed != 0) {
    return write_failure(file, error_text(failed));
  }
  // The name must survive a power cut as well; where directories cannot be flushed it does not.
  flush_to_disk(directory_of(file), O_RDONLY | O_DIRECTORY);
  return bytes;
}

}  // namespace warren
