// SPDX-License-Identifier: Apache-2.0
// A node's word on itself: what is read encodes to the same bytes.
#include <algorithm>
#include <cassert>

#include "daemon/fleet/node_status.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const std::span<const std::uint8_t> bytes(data, size);
  const auto status = read_node_status(bytes);
  if (!status) return 0;
  assert(!status->name.empty() && status->name.size() <= NodeStatus::kNameBytesMax);
  assert(!status->position_fleet || status->position_fleet->allFinite());
  assert(std::ranges::equal(encode(*status), bytes));
  return 0;
}
