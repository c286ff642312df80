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
  return 0;
}
