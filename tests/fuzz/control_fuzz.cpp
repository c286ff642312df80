// SPDX-License-Identifier: Apache-2.0
// One request to the control socket: a path that is let through is safe to print and to open, a
// number is finite.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "daemon/control/request.hpp"
#include "daemon/ingest/header.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  silence_protobuf();
  const auto request = decode_control_request(fuzz::bytes_of(data, size));
  if (!request) {
    assert(!request.error().empty());
    return 0;
  }
  if (const auto* const order = std::get_if<SaveOrder>(&*request)) {
    const std::string& path = order->path.native();
    assert(order->path.is_absolute());
    assert(path.size() <= size && path.size() < 4096);
    assert(std::none_of(path.begin(), path.end(),
                        [](unsigned char c) { return c < 0x20 || c == 0x7F; }));
  }
  if (const auto* const order = std::get_if<MoveOrder>(&*request)) {
    assert(order->shift.shift_fleet_m.allFinite() && std::isfinite(order->shift.yaw_rad));
  }
  if (const auto* const question = std::get_if<CellsQuestion>(&*request)) {
    assert(question->low_map.allFinite() && question->high_map.allFinite());
    assert((question->low_map.array() <= question->high_map.array()).all());
  }
  if (const auto* const question = std::get_if<BlocksQuestion>(&*request)) {
    assert(!question->box || (question->box->low.allFinite() && question->box->high.allFinite()));
    assert(question->wait_s >= 0.0 && question->wait_s <= 60.0);
    assert(question->rate_hz >= 0.1 && question->rate_hz <= 10.0);
    assert(question->most_bytes >= 4096 && question->most_bytes <= 1048576);
    if (const auto& cursor = question->cursor) {
      assert(cursor->scope == question->scope() && cursor->since <= cursor->until);
      assert(decode_cursor(encode_cursor(*cursor)) == *cursor);
    }
  }
  if (const auto* const question = std::get_if<RaysQuestion>(&*request)) {
    assert(!question->rays.empty() && question->rays.size() <= 1024);
    assert(question->max_range_m > 0.0 && std::isfinite(question->max_range_m));
    for (const MapRay& ray : question->rays) {
      assert(ray.origin_map.allFinite());
      assert(std::abs(ray.direction_map.norm() - 1.0) < 1e-9);
    }
  }
  return 0;
}
