// SPDX-License-Identifier: Apache-2.0
#include "tools/rivals/changed_voxel.hpp"

#include <algorithm>

namespace warren {

std::vector<ChangedVoxel> changed_voxels(std::span<const CodedBlock> now,
                                         const Replica& published) {
  std::vector<ChangedVoxel> changed;
  for (const CodedBlock& block : now) {
    const LayerBlock* const before = published.find(block.block);
    const BlockCodes codes = before != nullptr ? before->codes.unpack() : BlockCodes{};
    block.codes.for_each_known([&](std::uint32_t place, VoxelCode code) {
      if (code != codes.at(place)) changed.push_back({block.block << 9 | place, code});
    });
  }
  std::sort(changed.begin(), changed.end(),
            [](const ChangedVoxel& a, const ChangedVoxel& b) { return a.morton < b.morton; });
  return changed;
}

}  // namespace warren
