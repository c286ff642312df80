// SPDX-License-Identifier: Apache-2.0
// A beacon's content: what is read encodes to the same bytes.
#include <algorithm>
#include <cassert>

#include "tests/fuzz/fuzz_input.hpp"
#include "transport/wire/beacon.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  using namespace warren::mesh;
  const std::span<const std::uint8_t> content(data, size);
  const auto beacon = read_beacon(content);
  if (!beacon) return 0;
  assert(beacon->heard.size() <= Beacon::kHeardMax);
  assert(std::ranges::equal(encode(*beacon), content));
  return 0;
}
