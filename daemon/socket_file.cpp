// SPDX-License-Identifier: Apache-2.0
#include "daemon/socket_file.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace warren {
namespace {

constexpr int kBacklog = 16;

tl::unexpected<std::string> failure(const std::filesystem::path& path, const std::string& what) {
  return tl::unexpected(path.string() + ": " + what + ": " + std::strerror(errno));
}

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  assert(path.native().size() <= sizeof address.sun_path - 1);
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  return address;
}

// The socket API wants every address behind this type.
const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

int new_socket() { return ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

// 0, or the error of an attempt to connect.
int connect_error(const std::filesystem::path& path) {
  const int descriptor = new_socket();
  if (descriptor < 0) return errno;
  const sockaddr_un address = address_of(path);
  const int error = ::connect(descriptor, generic(address), sizeof address) == 0 ? 0 : errno;
  ::close(descriptor);
  return error;
}

// Removes a socket file behind which nobody listens.
tl::expected<void, std::string> remove_stale(const std::filesystem::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return {};
    return failure(path, "cannot look at the socket file");
  }
  if (!S_ISSOCK(status.st_mode)) {
    return tl::unexpected(path.string() + ": is there and no socket; move it out of the way");
  }
  const int error = connect_error(path);
  if (error != ECONNREFUSED && error != ENOENT) {
    return tl::unexpected(path.string() +
                          ": another process listens there; stop it or configure another path");
  }
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
    return failure(path, "cannot remove the socket file of a dead process");
  }
  return {};
}

}  // namespace

tl::expected<SocketFile, std::string> SocketFile::listen(const SocketConfig& config) {
  if (const auto removed = remove_stale(config.path); !removed) {
    return tl::unexpected(removed.error());
  }
  const int descriptor = new_socket();
  if (descriptor < 0) return failure(config.path, "cannot make a socket");
  SocketFile socket(config.path, descriptor);
  if (const auto listening = socket.bind_and_listen(config.mode); !listening) {
    return tl::unexpected(listening.error());
  }
  return socket;
}

tl::expected<void, std::string> SocketFile::bind_and_listen(FileMode mode) {
  // The mode before bind() can only be narrowed by the umask, never widened: nobody slips in
  // before chmod() sets it exactly.
  if (::fchmod(descriptor_, mode.bits) != 0) return failure(path_, "cannot set the socket's mode");
  const sockaddr_un address = address_of(path_);
  if (::bind(descriptor_, generic(address), sizeof address) != 0) {
    return failure(path_, "cannot create the socket (does its directory exist?)");
  }
  file_ = ::open(path_.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC);
  if (::chmod(path_.c_str(), mode.bits) != 0) return failure(path_, "cannot set the socket's mode");
  if (::listen(descriptor_, kBacklog) != 0) return failure(path_, "cannot listen");
  return {};
}

SocketFile::SocketFile(SocketFile&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      file_(std::exchange(other.file_, -1)) {}

SocketFile::~SocketFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (file_ < 0) return;
  struct stat ours {};
  struct stat there {};
  const bool is_ours = ::fstat(file_, &ours) == 0 && ::lstat(path_.c_str(), &there) == 0 &&
                       ours.st_dev == there.st_dev && ours.st_ino == there.st_ino;
  if (is_ours) ::unlink(path_.c_str());
  ::close(file_);
}

int SocketFile::release_descriptor() { return std::exchange(descriptor_, -1); }

}  // namespace warren
