// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a packet's body is made of around the voxels of its blocks, for any coder that offers the
// calls of ModelDecoder.

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "core/layer/block_codec.hpp"
#include "core/layer/diff_packet.hpp"

namespace warren {
namespace packet_body {

using namespace diff_context;

inline const BlockCodes* find_told(std::span<const BlockDiff> told, const BlockKey& key) {
  constexpr std::int32_t kBlockKeyMin = kKeyMin / kBlockEdge;
  if (std::min({key.x, key.y, key.z}) < kBlockKeyMin) return nullptr;
  const BlockOrdinal wanted = ordinal_of(key);
  const auto found = std::lower_bound(
      told.begin(), told.end(), wanted,
      [](const BlockDiff& diff, BlockOrdinal ordinal) { return diff.block < ordinal; });
  return found != told.end() && found->block == wanted ? &found->codes : nullptr;
}

inline PastNeighbours past_neighbours(std::span<const BlockDiff> told, BlockOrdinal block) {
  const auto [x, y, z] = block_key_of(block);
  return {find_told(told, {x - 1, y, z}), find_told(told, {x, y - 1, z}),
          find_told(told, {x, y, z - 1})};
}

// What comes before a block's voxels. The decoder fills in `diff` and returns whether to code them
// raw; what it reads may lie outside the claim.
template <typename Coder>
bool code_block_header(Coder& coder, const Claim& claim, std::span<const BlockDiff> told,
                       BlockDiff& diff, bool raw) {
  const BlockDiff* const before = told.empty() ? nullptr : &told.back();
  const BlockOrdinal least = before != nullptr ? before->block + 1 : claim.keys.first;
  diff.block = least + code_number(coder, kKeyStep, diff.block - least);

  // Where only one revision is claimed, there is nothing to tell.
  if (claim.to.number - claim.from.number > 1) {
    const Revision expected = before != nullptr ? before->changed_at : claim.to;
    if (coder.bit(kSameAge, diff.changed_at == expected)) {
      diff.changed_at = expected;
    } else {
      const std::uint64_t age = code_number(coder, kAge, claim.to.number - diff.changed_at.number);
      const std::uint64_t ages = claim.to.number - claim.from.number;
      diff.changed_at.number = age < ages ? claim.to.number - static_cast<std::uint32_t>(age) : 0;
    }
  } else {
    diff.changed_at = claim.to;
  }
  const bool replaced_before = before != nullptr && before->replaces;
  diff.replaces = coder.bit(kReplaces + (replaced_before ? 1 : 0), diff.replaces);
  return coder.bit(kRaw, raw);
}

inline bool claimed(const Claim& claim, const BlockDiff& diff) {
  return claim.keys.contains(diff.block) && claim.from < diff.changed_at &&
         diff.changed_at <= claim.to;
}

// The blocks of a packet; kMalformed if the bytes are none that a writer makes.
template <typename Coder>
tl::expected<std::vector<BlockDiff>, PacketError> read_body(Coder& coder, const Claim& claim) {
  std::vector<BlockDiff> told;
  while (coder.bit(kMoreBlocks, false)) {
    if (told.size() == kBlocksPerPacketMax) return tl::unexpected(PacketError::kMalformed);
    BlockDiff diff;
    const bool raw = code_block_header(coder, claim, told, diff, false);
    if (coder.overrun() || !claimed(claim, diff)) {
      return tl::unexpected(PacketError::kMalformed);
    }
    if (raw) {
      code_voxels_raw(coder, diff.codes);
    } else {
      code_voxels(coder, past_neighbours(told, diff.block), diff.codes);
    }
    if (coder.overrun()) return tl::unexpected(PacketError::kMalformed);
    told.push_back(diff);
  }
  if (!coder.finished()) return tl::unexpected(PacketError::kMalformed);
  return told;
}

}  // namespace packet_body
}  // namespace warren
