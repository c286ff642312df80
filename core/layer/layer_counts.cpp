// SPDX-License-Identifier: Apache-2.0
#include "core/layer/layer_counts.hpp"

#include <bit>

namespace warren {

MapCounts counts_of(const Replica& layer) {
  MapCounts counts;
  layer.for_each_changed({}, {}, [&](BlockOrdinal, const LayerBlock& block) {
    for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
      const auto occupied = static_cast<unsigned>(std::popcount(block.codes.occupied()[cell]));
      counts.occupied += occupied;
      counts.free += static_cast<unsigned>(std::popcount(block.codes.known()[cell])) - occupied;
    }
    counts.blocks += block.codes.empty() ? 0 : 1;
    return true;
  });
  return counts;
}

}  // namespace warren
