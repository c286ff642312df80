// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/test_client.hpp"

#include <array>
#include <cstring>
#include <utility>

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"

namespace warren {

TestClient::TestClient(const std::filesystem::path& socket)
    : descriptor_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval patience{60, 0};
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setsockopt(descriptor_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket.c_str(), socket.native().size());
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  REQUIRE(::connect(descriptor_, generic, sizeof address) == 0);
}

TestClient::TestClient(TestClient&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

void TestClient::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void TestClient::end_writing() { ::shutdown(descriptor_, SHUT_WR); }

bool TestClient::write(const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const auto count = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

bool TestClient::read_exactly(char* bytes, std::size_t count) {
  for (std::size_t read = 0; read < count;) {
    const auto got = ::recv(descriptor_, bytes + read, count - read, 0);
    REQUIRE_FALSE((got < 0 && errno == EAGAIN));
    if (got <= 0) return false;
    read += static_cast<std::size_t>(got);
  }
  return true;
}

std::optional<std::string> TestClient::read_frame() {
  std::array<std::byte, 4> length{};
  if (!read_exactly(reinterpret_cast<char*>(length.data()), length.size())) return std::nullopt;
  std::string frame(read_length(length), '\0');
  if (!read_exactly(frame.data(), frame.size())) return std::nullopt;
  return frame;
}

std::optional<ingest::IngestReply> TestClient::read_reply() {
  const auto frame = read_frame();
  if (!frame) return std::nullopt;
  ingest::IngestReply reply;
  REQUIRE(reply.ParseFromString(*frame));
  return reply;
}

ingest::ScanReceipt TestClient::read_receipt() {
  const auto reply = read_reply();
  REQUIRE(reply.has_value());
  REQUIRE(reply->has_receipt());
  return reply->receipt();
}

control::Response TestClient::ask(const control::Request& request) {
  REQUIRE(write(framed(request.SerializeAsString())));
  const auto frame = read_frame();
  REQUIRE(frame.has_value());
  control::Response response;
  REQUIRE(response.ParseFromString(*frame));
  return response;
}

TestClient greeted_client(const std::filesystem::path& socket) {
  TestClient client(socket);
  REQUIRE(client.write(hello_frame()));
  const auto reply = client.read_reply();
  REQUIRE(reply.has_value());
  REQUIRE(reply->has_welcome());
  return client;
}

}  // namespace warren
