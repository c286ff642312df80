// SPDX-License-Identifier: Apache-2.0
#include "tools/link/trace_files.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include <doctest/doctest.h>

#include "tests/support/recorded_data.hpp"
#include "tests/tools/link/link_driver.hpp"

using namespace warren;
using namespace std::chrono_literals;

namespace {

tl::expected<TraceFile, std::string> read(const std::string& text) {
  std::istringstream in(text);
  return read_trace(in);
}

std::string error_of(const std::string& text) {
  const auto trace = read(text);
  return trace ? "none" : trace.error();
}

}  // namespace

TEST_CASE("a trace of one link sets rate, loss and delay at its times") {
  const auto trace = read("time_s,rate_bit_s,loss,delay_ms\n0,1e6,0,10\n1.5,,0.25,\n2,5e5,,20.5\n");
  REQUIRE(trace);
  const auto& link = std::get<LinkTrace>(*trace);
  REQUIRE(link.rates.size() == 2);
  CHECK(link.rates[1].at == 2s);
  CHECK(link.rates[1].bit_s == 5e5);
  REQUIRE(link.steps.size() == 3);
  CHECK(link.steps[1].loss == 0.25);
  CHECK(!link.steps[1].delay);
  CHECK(link.steps[2].delay == 20'500us);
}

TEST_CASE("a world's radio trace becomes links between its nodes; a dead link keeps its rate") {
  const auto trace = read(
      "time_s,from,to,loss,rate_bit_s\n"
      "0.000,base,robot-0,0.100000,54000000\n0.000,robot-0,base,1.000000,0\n"
      "1.000,base,robot-0,1.000000,0\n1.000,robot-0,base,1.000000,0\n");
  REQUIRE(trace);
  const auto& file = std::get<RadioTraceFile>(*trace);
  CHECK(file.names == std::vector<std::string>{"base", "robot-0"});
  REQUIRE(file.links.size() == 2);
  CHECK(file.links[0].trace.rates.size() == 1);
  CHECK(file.links[0].trace.steps[0].loss == 0.1);
  CHECK(file.links[0].trace.steps[1].loss == 1.0);
  REQUIRE(file.links[1].trace.rates.size() == 1);
  CHECK(file.links[1].trace.rates[0].bit_s == 54e6);
}

TEST_CASE("mahimahi's and Rutgers' files are known by their first line") {
  const auto list = read("0\n3\n3\n10\n");
  REQUIRE(list);
  CHECK(std::get<Opportunities>(*list).at_ms == std::vector<std::uint32_t>{0, 3, 3, 10});
  const auto pattern = read("0 40\n2 41\n3 128\n");
  REQUIRE(pattern);
  const auto& lost = std::get<LossPattern>(*pattern).lost;
  REQUIRE(lost.size() == 300);
  CHECK(!lost[0]);
  CHECK(lost[1]);
  CHECK(!lost[2]);
  CHECK(lost[3]);  // received with an error
  CHECK(std::get<LossPattern>(*read("")).lost == std::vector<bool>(300, true));
}

TEST_CASE("a file that is wrong is refused with its line") {
  CHECK(error_of("time_s,rate_bit_s,loss,delay_ms\n") == "line 1: no step");
  CHECK(error_of("time_s,rate_bit_s,loss,delay_ms\n0,1,1\n") == "line 2: not four fields");
  CHECK(error_of("time_s,rate_bit_s,loss,delay_ms\n1,1,1,1\n1,1,1,1\n") ==
        "line 3: time does not rise");
  for (const char* fields : {"0,-1,0,0", "0,1,1.1,0", "0,1,x,0", "0,nan,0,0", "0,1,0,inf"}) {
    CHECK(error_of(std::string("time_s,rate_bit_s,loss,delay_ms\n") + fields) ==
          "line 2: a number is missing or out of range");
  }
  CHECK(error_of("time_s,from,to,loss,rate_bit_s\n0,a,a,0,1\n") == "line 2: a node hears itself");
  CHECK(error_of("time_s,from,to,loss,rate_bit_s\n0,a,b,0,1\n0,a,b,0,1\n") ==
        "line 3: time does not rise");
  CHECK(error_of("5\n4\n") == "line 2: time goes back");
  CHECK(error_of("0\n") == "line 1: the last time must be above 0");
  CHECK(error_of("hello\n") == "line 1: not a whole number of milliseconds");
  CHECK(error_of("1 2 3\n") == "line 1: not a number and an RSSI");
}

TEST_CASE("a saturating sender gets all of a recorded cellular link and no more") {
  const test::UnpackedData data("net/mahimahi_traces.tar.xz");
  if (!data.is_there()) return;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data.folder())) {
    const std::string ending = entry.path().extension();
    if (ending != ".up" && ending != ".down") continue;
    const auto trace = read_trace_file(entry.path());
    REQUIRE_MESSAGE(trace, trace.error());
    const auto& at_ms = std::get<Opportunities>(*trace).at_ms;
    LinkModelConfig config;
    config.queue.packets = 1'000'000;
    apply(*trace, config.link);
    LinkModel model(config);
    for (std::size_t i = 0; i < at_ms.size() + 10; ++i) {
      model.send(at_us(0), packet_of(Opportunities::kOpportunityBytes));
    }
    const auto round = arrivals_until(model, at_us(0) + std::chrono::milliseconds(at_ms.back()));
    CHECK(round.size() >= at_ms.size());
    CHECK(round.size() <= at_ms.size() + 10);
    ++files;
  }
  CHECK(files == 13);
}

TEST_CASE("the testbed's links deliver what its description says, by level of noise") {
  const test::UnpackedData data("net/rutgers_orbit_noise.tar.xz");
  if (!data.is_there()) return;
  std::map<std::string, std::pair<double, double>> delivered_of;  // sum of shares, links
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data.folder() / "data")) {
    if (!entry.is_regular_file()) continue;
    const auto trace = read_trace_file(entry.path());
    REQUIRE_MESSAGE(trace, trace.error());
    const auto& lost = std::get<LossPattern>(*trace).lost;
    auto& [shares, links] = delivered_of[entry.path().parent_path().parent_path().filename()];
    shares += static_cast<double>(std::count(lost.begin(), lost.end(), false)) /
              static_cast<double>(lost.size());
    links += 1.0;
  }
  std::vector<double> means;
  for (const auto& [level, sum] : delivered_of) means.push_back(sum.first / sum.second);
  std::sort(means.rbegin(), means.rend());
  REQUIRE(means.size() == 5);
  const double described[] = {0.86, 0.81, 0.70, 0.51, 0.31};
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(means[i] == doctest::Approx(described[i]).epsilon(0.03));
}
