// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace warren {

// A connected unix stream socket that speaks length-prefixed messages. Errors are sentences for the
// operator. Closes when destroyed.
class UnixStream {
 public:
  static constexpr std::size_t kMaxMessageBytes = 1 << 20;

  static tl::expected<UnixStream, std::string> connect(const std::string& path);
  ~UnixStream();
  UnixStream(UnixStream&& other) noexcept;
  UnixStream& operator=(UnixStream&& other) noexcept;
  UnixStream(const UnixStream&) = delete;
  UnixStream& operator=(const UnixStream&) = delete;

  tl::expected<void, std::string> send_message(const std::string& message);
  tl::expected<void, std::string> send_bytes(std::span<const std::byte> bytes);

  // The next message; nothing if none began within the timeout.
  tl::expected<std::optional<std::string>, std::string> receive_message(
      std::chrono::milliseconds timeout);

 private:
  explicit UnixStream(int fd) : fd_(fd) {}
  tl::expected<void, std::string> receive_exactly(std::span<std::byte> bytes);

  int fd_ = -1;
};

}  // namespace warren
