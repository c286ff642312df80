// SPDX-License-Identifier: Apache-2.0
#include "tools/rivals/changed_voxel.hpp"

#include <algorithm>

namespace warren {

std::vector<ChangedVoxel> changed_voxels(std::span<const CodedBlock> now,
                                         const Replica& published) {
  std::vector<ChangedVoxel> changed;
  for (const CodedBlock& block : now) {
    const BlockCodes codes = published.codes(block.block).unpack();
    block.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      if (code != codes.at(place)) changed.push_back({block.block << 9 | place, code});
    });
  }
  std::sort(changed.begin(), changed.end(),
            [](const ChangedVoxel& a, const ChangedVoxel& b) { return a.morton < b.morton; });
  return changed;
}

}  // namespace warren
