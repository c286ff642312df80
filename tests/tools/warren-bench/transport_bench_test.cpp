// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

// The command itself, on short transfers: that each transport comes through and that the figures
// are those of the link.

namespace {

bool may_make_namespaces() {
  if (geteuid() == 0 && std::filesystem::exists("/dev/net/tun")) return true;
  MESSAGE("SKIPPED: network namespaces need root and /dev/net/tun");
  return false;
}

nlohmann::json bench(const std::string& arguments) {
  const std::string command = std::string(WARREN_BENCH) + " transport --json " + arguments;
  FILE* output = popen(command.c_str(), "r");
  REQUIRE(output != nullptr);
  std::string text;
  char bytes[4096];
  while (const std::size_t got = std::fread(bytes, 1, sizeof(bytes), output)) {
    text.append(bytes, got);
  }
  REQUIRE(pclose(output) == 0);
  return nlohmann::json::parse(text);
}

}  // namespace

TEST_CASE("every transport brings a payload over a clean link, none faster than it") {
  if (!may_make_namespaces()) return;
  const auto result = bench("--bytes 200000 --rate 2e6 --rtt-ms 20 --jobs 5");
  CHECK(result["peers"].size() == 5);
  for (const auto& entry : result["peers"].items()) {
    const auto& peer = entry.value();
    CAPTURE(entry.key());
    if (peer.contains("available")) continue;  // this kernel has no bbr
    CHECK(!peer.contains("problem"));
    REQUIRE(peer["seconds"].is_number());
    CHECK(peer["seconds"] > 0.8);     // the payload alone takes so long
    CHECK(peer["efficiency"] > 0.0);  // on a busy machine some are slow
    CHECK(peer["efficiency"] < 1.0);
    CHECK(peer["oversend"] > 1.0);
    CHECK(peer["oversend"] < 3.0);
    CHECK(peer["first_byte_s"] >= 0.01);
  }
}

TEST_CASE("a transport that does not come through in time has no seconds") {
  if (!may_make_namespaces()) return;
  const auto result = bench("--bytes 1000000 --rate 1e6 --rtt-ms 20 --limit-s 2 --peers tcp-cubic");
  const auto& peer = result["peers"]["tcp-cubic"];
  CHECK(peer["seconds"].is_null());
  CHECK(peer["efficiency"] > 0.0);
}

TEST_CASE("a blackout is waited for, and the first byte after it is told") {
  if (!may_make_namespaces()) return;
  const auto result =
      bench("--bytes 100000 --rate 1e6 --rtt-ms 20 --blackout-s 1 --peers tcp-cubic");
  const auto& peer = result["peers"]["tcp-cubic"];
  CHECK(peer["seconds"] > 1.8);
  CHECK(peer["first_byte_s"] >= 0.01);
  CHECK(peer["first_byte_s"] < 20.0);
}

TEST_CASE("beside another flow both shares of the link are told") {
  if (!may_make_namespaces()) return;
  const auto result = bench(
      "--bytes 400000 --rate 2e6 --rtt-ms 20 --peers ours,tcp-cubic --against tcp-cubic --jobs 2");
  CHECK(result["against"] == "tcp-cubic");
  for (const auto& entry : result["peers"].items()) {
    const auto& peer = entry.value();
    CAPTURE(entry.key());
    CHECK(!peer.contains("problem"));
    CHECK(peer["share"] > 0.01);
    CHECK(peer["share"] < 0.99);
    CHECK(peer["rival_efficiency"] > 0.0);
    CHECK(peer["efficiency"].get<double>() + peer["rival_efficiency"].get<double>() < 1.0);
    CHECK(peer["oversend"].is_null());
  }
}
