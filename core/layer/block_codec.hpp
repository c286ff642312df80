// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"
#include "core/layer/model_coder.hpp"

namespace warren {

// What a packet tells of one block.
struct BlockDiff {
  BlockOrdinal block = 0;
  Revision changed_at;    // the block's last change, at or before the packet's `to`
  bool replaces = false;  // `codes` is the whole block; otherwise only the voxels it knows changed
  BlockCodes codes;

  friend bool operator==(const BlockDiff&, const BlockDiff&) = default;
};

// The blocks below this one along x, y and z as told by the same packet; null where it tells none.
using PastNeighbours = std::array<const BlockCodes*, 3>;

// Codes the voxels of a block, large uniform parts first, each with what is told of its six
// neighbours as context. The decoder overwrites `codes`, which must be empty; any input gives codes
// that keep their invariant, in bounded time.
template <typename Coder>
void code_voxels(Coder& coder, const PastNeighbours& past, BlockCodes& codes);

// The same at a fixed length per voxel, at most kRawBlockBytes, whatever the codes.
inline constexpr std::size_t kRawBlockBytes = 384;
template <typename Coder>
void code_voxels_raw(Coder& coder, BlockCodes& codes);

extern template void code_voxels(ModelEncoder&, const PastNeighbours&, BlockCodes&);
extern template void code_voxels(ModelDecoder&, const PastNeighbours&, BlockCodes&);
extern template void code_voxels_raw(ModelEncoder&, BlockCodes&);
extern template void code_voxels_raw(ModelDecoder&, BlockCodes&);

}  // namespace warren
