// SPDX-License-Identifier: Apache-2.0
#include "tools/client/unix_stream.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "proto/framing.hpp"

namespace warren {
namespace {

std::string reason_of(int error, const std::string& path) {
  if (error == ENOENT || error == ECONNREFUSED) {
    return "no daemon listens at " + path + ": is warrend running, with this socket in its config?";
  }
  if (error == EACCES) {
    return "not allowed to connect to " + path +
           ": run as root, or as a member of the socket's group";
  }
  return "cannot connect to " + path + ": " + std::strerror(error);
}

}  // namespace

tl::expected<UnixStream, std::string> UnixStream::connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(address.sun_path)) {
    return tl::unexpected("socket path must have 1 to " +
                          std::to_string(sizeof(address.sun_path) - 1) + " bytes: " + path);
  }
  path.copy(address.sun_path, path.size());
  UnixStream stream(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (stream.fd_ < 0 ||
      ::connect(stream.fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return tl::unexpected(reason_of(errno, path));
  }
  return stream;
}

UnixStream::~UnixStream() {
  if (fd_ >= 0) ::close(fd_);
}

UnixStream::UnixStream(UnixStream&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

UnixStream& UnixStream::operator=(UnixStream&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

tl::expected<void, std::string> UnixStream::send_message(const std::string& message) {
  const std::string frame = framed(message);
  return send_bytes(std::as_bytes(std::span(frame)));
}

tl::expected<void, std::string> UnixStream::send_bytes(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      return tl::unexpected(std::string("the daemon went away: ") + std::strerror(errno));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return {};
}

tl::expected<std::optional<std::string>, std::string> UnixStream::receive_message(
    std::chrono::milliseconds timeout) {
  pollfd waiting{fd_, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, static_cast<int>(timeout.count()));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return std::nullopt;
  if (ready < 0) return tl::unexpected(std::string("poll: ") + std::strerror(errno));

  std::array<std::byte, 4> length_bytes{};
  if (const auto received = receive_exactly(length_bytes); !received) {
    return tl::unexpected(received.error());
  }
  const std::uint32_t length = read_length(length_bytes);
  if (length > kMaxMessageBytes)
    return tl::unexpected(std::string("the daemon sent a message too long"));
  std::string message(length, '\0');
  if (const auto received = receive_exactly(std::as_writable_bytes(std::span(message)));
      !received) {
    return tl::unexpected(received.error());
  }
  return message;
}

tl::expected<void, std::string> UnixStream::receive_exactly(std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t received = ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (received < 0 && errno == EINTR) continue;
    if (received == 0) return tl::unexpected(std::string("the daemon closed the connection"));
    if (received < 0) {
      return tl::unexpected(std::string("the daemon went away: ") + std::strerror(errno));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(received));
  }
  return {};
}

}  // namespace warren
