// SPDX-License-Identifier: Apache-2.0
#include "daemon/socket_file.hpp"

#include <fstream>
#include <optional>

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/temporary_directory.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {

TEST_CASE("a socket file has exactly its mode and goes with its owner") {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.sock";
  const mode_t umask_before = umask(0077);
  {
    const auto socket = SocketFile::listen({path, FileMode{0660}});
    REQUIRE_MESSAGE(socket.has_value(), socket.error());
    struct stat status {};
    REQUIRE(lstat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0660U);
    TestClient client(path);
  }
  umask(umask_before);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a stale socket is replaced, a live one and other files are not") {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.sock";
  std::optional<SocketFile> first(std::move(*SocketFile::listen({path, FileMode{0600}})));
  const auto second = SocketFile::listen({path, FileMode{0600}});
  REQUIRE_FALSE(second.has_value());
  CHECK(second.error().find("another process listens there") != std::string::npos);

  ::close(first->release_descriptor());  // as if it had been killed
  {
    const auto third = SocketFile::listen({path, FileMode{0600}});
    REQUIRE_MESSAGE(third.has_value(), third.error());
    first.reset();
    CHECK(std::filesystem::exists(path));  // no longer the first one's to remove
  }

  std::ofstream(path) << "precious";
  const auto fourth = SocketFile::listen({path, FileMode{0600}});
  REQUIRE_FALSE(fourth.has_value());
  CHECK(fourth.error().find("no socket") != std::string::npos);
  CHECK(std::filesystem::file_size(path) == 8);
}

TEST_CASE("a directory that is not there is named") {
  const auto socket = SocketFile::listen({"/nowhere/a.sock", FileMode{0600}});
  REQUIRE_FALSE(socket.has_value());
  CHECK(socket.error().find("/nowhere/a.sock") == 0);
}

}  // namespace warren
