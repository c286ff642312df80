// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_difference.hpp"

#include <cassert>

namespace warren {
namespace {

void add(LayerDifference& difference, VoxelCode a, VoxelCode b) {
  if (a == b) return;
  if (b.state() == VoxelState::kUnknown) {
    ++difference.only_in_a;
  } else if (a.state() == VoxelState::kUnknown) {
    ++difference.only_in_b;
  } else if (a.state() != b.state()) {
    ++difference.occupancy;
  } else {
    difference.cost += a.cost() != b.cost() ? 1 : 0;
    difference.stair += a.stair() != b.stair() ? 1 : 0;
  }
}

}  // namespace

LayerDifference difference_of(const Replica& a, const Replica& b) {
  assert(a.resolution() == b.resolution());
  LayerDifference difference;
  for (const RegionOrdinal region : differing(a.digest().regions(), b.digest().regions())) {
    for (const BlockOrdinal block : differing(a.digest_blocks(region), b.digest_blocks(region))) {
      const BlockCodes codes_a = a.codes(block).unpack();
      const BlockCodes codes_b = b.codes(block).unpack();
      for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
        add(difference, codes_a.at(place), codes_b.at(place));
      }
    }
  }
  return difference;
}

}  // namespace warren
