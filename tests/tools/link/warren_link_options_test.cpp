// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <unistd.h>

#include "tools/warren-link/options.hpp"

using namespace warren;
using namespace std::chrono_literals;

namespace {

// When a packet of 1250 bytes arrives, or nothing within 10 s.
std::optional<Duration> takes(LinkModel& model, StationIndex from, StationIndex to) {
  const MeshTime start{};
  model.send(start, {from, to, 1250, {}});
  const auto delivery = model.poll(start + 10s);
  if (!delivery) return {};
  return delivery->at - start;
}

std::string error_of(const LinkOptions& options) {
  const auto model = make_model(options, {});
  return model ? "none" : model.error();
}

}  // namespace

TEST_CASE("flags hold for all directions, --link for one") {
  LinkOptions options;
  options.link.rate_bit_s = 1e6;
  options.link.delay_ms = 5;
  options.overrides = {"1,0,rate=1e5,delay-ms=0.5"};
  auto model = make_model(options, {});
  REQUIRE_MESSAGE(model, model.error());
  CHECK(takes(*model, 0, 1) == 15ms);
  auto back = make_model(options, {});
  CHECK(takes(*back, 1, 0) == 100'500us);
}

TEST_CASE("what is wrong is said") {
  LinkOptions options;
  options.overrides = {"1,0,speed=3"};
  CHECK(error_of(options) == "--link: no setting speed");
  options.overrides = {"1,0,loss=3"};
  CHECK(error_of(options) == "--link: no value for loss in loss=3");
  options.overrides = {"1,2,loss=0"};
  CHECK(error_of(options) == "--link: no node 2");
  options.overrides = {"1,1,loss=0"};
  CHECK(error_of(options) == "--link wants FROM,TO,NAME=VALUE,..");
  options.overrides.clear();
  options.blackouts_s = {{2, 3}, {1, 2}};
  CHECK(error_of(options) == "blackouts must rise and not overlap");
  options.blackouts_s.clear();
  options.trace = "/no/such/file";
  CHECK(error_of(options) == "cannot read /no/such/file");
}

TEST_CASE("traces set the directions that they tell of") {
  const auto path = std::filesystem::temp_directory_path() /
                    ("warren-link-options-" + std::to_string(getpid()) + ".csv");
  LinkOptions options;
  options.nodes = 3;
  std::ofstream(path) << "time_s,from,to,loss,rate_bit_s\n"
                         "0,a,b,0,1000000\n0,b,a,1,0\n0,a,c,0,2000000\n";
  options.trace = path;
  auto model = make_model(options, {});
  REQUIRE_MESSAGE(model, model.error());
  CHECK(takes(*model, 0, 1) == 10ms);
  auto others = make_model(options, {});
  CHECK(!takes(*others, 1, 0));
  options.nodes = 2;
  CHECK(error_of(options) == path.string() + " has 3 nodes: say so with --nodes");

  std::ofstream(path) << "time_s,rate_bit_s,loss,delay_ms\n0,1e6,,7\n";
  options.trace.clear();
  options.trace_back = path;
  auto one_way = make_model(options, {});
  REQUIRE(one_way);
  CHECK(takes(*one_way, 1, 0) == 17ms);
  auto other_way = make_model(options, {});
  CHECK(takes(*other_way, 0, 1) == 0ms);
  std::filesystem::remove(path);
}
