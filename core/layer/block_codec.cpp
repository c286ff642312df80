// SPDX-License-Identifier: Apache-2.0
#include "core/layer/block_codec.hpp"

#include "core/layer/block_walk.hpp"

namespace warren {

template void code_voxels(ModelEncoder&, const PastNeighbours&, BlockCodes&);
template void code_voxels(ModelDecoder&, const PastNeighbours&, BlockCodes&);
template void code_voxels_raw(ModelEncoder&, BlockCodes&);
template void code_voxels_raw(ModelDecoder&, BlockCodes&);

}  // namespace warren
