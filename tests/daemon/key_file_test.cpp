// SPDX-License-Identifier: Apache-2.0
#include "daemon/key_file.hpp"

#include <fstream>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "tests/daemon/temporary_directory.hpp"

namespace warren {
namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
  REQUIRE(chmod(file.c_str(), 0600) == 0);
}

std::string error_of(const std::filesystem::path& file) {
  const auto key = read_key_file(file);
  REQUIRE_FALSE(key.has_value());
  CHECK(key.error().find(file.string()) != std::string::npos);
  return key.error();
}

}  // namespace

TEST_CASE("a fresh key is for its owner alone, is read back, and is another each time") {
  const TemporaryDirectory directory;
  REQUIRE(make_key_file(directory / "a.key").has_value());
  REQUIRE(make_key_file(directory / "b.key").has_value());
  struct stat facts {};
  REQUIRE(stat((directory / "a.key").c_str(), &facts) == 0);
  CHECK((facts.st_mode & 0777) == 0600);
  const auto a = read_key_file(directory / "a.key");
  const auto b = read_key_file(directory / "b.key");
  REQUIRE(a.has_value());
  REQUIRE(b.has_value());
  CHECK(*a != *b);
  CHECK(*a != mesh::Key{});
  CHECK(*read_key_file(directory / "a.key") == *a);
}

TEST_CASE("a key file that is there stays as it is") {
  const TemporaryDirectory directory;
  REQUIRE(make_key_file(directory / "a.key").has_value());
  const auto before = read_key_file(directory / "a.key");
  const auto again = make_key_file(directory / "a.key");
  REQUIRE_FALSE(again.has_value());
  CHECK(again.error().find("already") != std::string::npos);
  CHECK(*read_key_file(directory / "a.key") == *before);
  CHECK_FALSE(make_key_file(directory / "nowhere/a.key").has_value());
}

TEST_CASE("a key that others may read or write is refused") {
  const TemporaryDirectory directory;
  const auto file = directory / "a.key";
  REQUIRE(make_key_file(file).has_value());
  for (const mode_t mode : {0640U, 0604U, 0620U, 0602U, 0610U}) {
    REQUIRE(chmod(file.c_str(), mode) == 0);
    CHECK(error_of(file).find("chmod 600") != std::string::npos);
  }
  REQUIRE(chmod(file.c_str(), 0400) == 0);
  CHECK(read_key_file(file).has_value());
}

TEST_CASE("what is no key file is refused with a reason") {
  const TemporaryDirectory directory;
  const auto file = directory / "a.key";
  CHECK(error_of(file).find("warrenctl key new") != std::string::npos);
  const std::string digits(64, 'a');
  for (const std::string& text :
       {std::string(), std::string("warren-fleet-key-1 "), "warren-fleet-key-2 " + digits + "\n",
        "warren-fleet-key-1 " + digits.substr(1) + "\n", "warren-fleet-key-1 " + digits + "a\n",
        "warren-fleet-key-1 " + digits.substr(1) + "g\n", "warren-fleet-key-1 " + digits + "\n\n",
        digits}) {
    CAPTURE(text);
    write_text(file, text);
    CHECK(error_of(file).find("no fleet key") != std::string::npos);
  }
  write_text(file, "warren-fleet-key-1 " + digits + "\n");
  CHECK(read_key_file(file).has_value());
  std::filesystem::create_directory(directory / "folder");
  REQUIRE(chmod((directory / "folder").c_str(), 0700) == 0);
  CHECK(error_of(directory / "folder").find("regular") != std::string::npos);
}

}  // namespace warren
