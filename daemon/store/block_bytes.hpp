// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/layer/replica.hpp"
#include "core/voxel/block_state.hpp"

namespace warren {

// A block of a layer, and one of a self-map, as rows of a store; their keys are not among the
// bytes. Decoders trust nothing, and take no bytes but those that the encoders make.
std::vector<std::uint8_t> encode_block(const StoredBlock& block);
std::optional<StoredBlock> decode_block(BlockOrdinal block, std::span<const std::uint8_t> bytes);

std::vector<std::uint8_t> encode_self_block(const BlockState& state);
std::optional<BlockState> decode_self_block(BlockOrdinal block,
                                            std::span<const std::uint8_t> bytes);

}  // namespace warren
