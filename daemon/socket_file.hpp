// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "daemon/config/config.hpp"

namespace warren {

// After a failed accept (say, no descriptors left), so that the server does not spin.
inline constexpr std::chrono::milliseconds kAcceptPause{100};

// A listening unix stream socket and its file. A file that a dead process left behind is replaced,
// one behind which somebody listens is not. The file goes with the object, if it is still ours.
class SocketFile {
 public:
  // The error tells the path and what to do.
  static tl::expected<SocketFile, std::string> listen(const SocketConfig& config);

  ~SocketFile();
  SocketFile(SocketFile&& other) noexcept;
  SocketFile& operator=(SocketFile&&) = delete;

  // Hands the listening descriptor over; the file stays here.
  int release_descriptor();

 private:
  SocketFile(std::filesystem::path path, int descriptor)
      : path_(std::move(path)), descriptor_(descriptor) {}
  tl::expected<void, std::string> bind_and_listen(FileMode mode);

  std::filesystem::path path_;
  int descriptor_ = -1;
  int file_ =
      -1;  // the file itself (O_PATH): while it is held, no other file gets its inode number
};

}  // namespace warren
