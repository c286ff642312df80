// SPDX-License-Identifier: Apache-2.0
// A diff packet: whatever is accepted keeps the replica's promises, and what the replica then tells
// makes an equal one.
#include <cassert>

#include "core/layer/replica.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

constexpr LayerId kLayer{1, 1, 1};

// A replica that holds revision 1 in a part of the key space, so that claims meet both.
Replica partly_filled() {
  BlockCodes codes;
  for (std::uint32_t place = 0; place < 100; ++place) codes.set(place, VoxelCode::free());
  codes.set(100, VoxelCode::occupied(3, true));
  Replica origin(kLayer, kDefaultResolution);
  origin.publish({{CodedBlock{0, CodeBlock(codes)}, CodedBlock{700, CodeBlock(codes)}}});
  Replica replica(kLayer, kDefaultResolution);
  replica.apply(kLayer, origin.encode({{0, 1000}, {}})->bytes);
  return replica;
}

void check_told_again(const Replica& replica) {
  Replica copy(kLayer, kDefaultResolution);
  KeyInterval keys;
  std::size_t packets = 0;
  while (const auto packet = replica.encode({keys, {}})) {
    assert(packet->bytes.size() <= 1200);
    const ApplyResult result = copy.apply(kLayer, packet->bytes);
    assert(result == ApplyResult::kApplied);
    keys.first = packet->claim.keys.end;
    ++packets;
  }
  assert(packets <= kBlocksPerPacketMax + Holdings::kIntervalsMax);
  assert(copy.digest().root() == replica.digest().root());
  assert(copy.holdings() == replica.holdings());
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  Replica replica = fuzz::partly_filled();
  const Holdings before = replica.holdings();
  const ApplyResult result = replica.apply(fuzz::kLayer, {data, size});
  if (result != ApplyResult::kApplied) {
    assert(replica.holdings() == before);
    return 0;
  }
  const auto header = read_header({data, size});
  assert(header && replica.holdings().highest(header->claim.keys) >= header->claim.to);
  assert(replica.apply(fuzz::kLayer, {data, size}) != ApplyResult::kApplied);
  fuzz::check_told_again(replica);
  replica.rest(replica.holdings().highest({}), kBlocksPerPacketMax);
  fuzz::check_told_again(replica);
  return 0;
}
