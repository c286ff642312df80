// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/transport_payload.hpp"

#include <doctest/doctest.h>

#include "tools/warren-bench/transport_bench.hpp"

using namespace warren;

namespace {

TransportRun run_of(std::optional<double> seconds, double efficiency) {
  TransportRun run;
  run.seconds = seconds;
  run.efficiency = efficiency;
  return run;
}

}  // namespace

TEST_CASE("a payload at another place, or with one byte changed, is not taken for it") {
  std::vector<std::uint8_t> bytes(1000);
  fill_payload(bytes, 5000);
  CHECK(is_payload(bytes, 5000));
  CHECK(!is_payload(bytes, 5001));
  CHECK(!is_payload(bytes, 5000 + 65'536));
  bytes[999] ^= 1;
  CHECK(!is_payload(bytes, 5000));
}

TEST_CASE("parts count once, in any order, overlapping or not") {
  PayloadReceived received(1000);
  CHECK(received.take(make_payload_part(500, 500)) == 500);
  CHECK(received.take(make_payload_part(500, 500)) == 0);
  CHECK(received.take(make_payload_part(0, 600)) == 500);
}

TEST_CASE("parts that are wrong count for nothing") {
  PayloadReceived received(1000);
  auto changed = make_payload_part(0, 100);
  changed.back() ^= 0x80;
  CHECK(received.take(changed) == 0);
  CHECK(received.take(make_payload_part(950, 51)) == 0);
  CHECK(received.take(std::vector<std::uint8_t>(kPartHeaderBytes)) == 0);
  CHECK(received.take({}) == 0);
}

TEST_CASE("a run that did not end counts as the longest in the median") {
  const auto middle = median_of({run_of({}, 0.1), run_of(3.0, 0.9), run_of(5.0, 0.7)});
  CHECK(middle.seconds == 5.0);
  CHECK(middle.efficiency == 0.7);
  CHECK(!median_of({run_of({}, 0.1), run_of(3.0, 0.9), run_of({}, 0.2)}).seconds);
}

TEST_CASE("the ideal time is that of the payload alone at what the loss leaves") {
  TransportOptions options;
  options.bytes = 125'000;
  options.rate_bit_s = 1e6;
  options.loss = 0.5;
  CHECK(ideal_s(options) == doctest::Approx(2.0));
  options.limit_s = 7.0;
  CHECK(time_limit_s(options) == 7.0);
}
