// SPDX-License-Identifier: Apache-2.0
#include "core/layer/diff_packet.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace warren {
namespace {

using namespace diff_context;

const BlockCodes* find_told(std::span<const BlockDiff> told, const BlockKey& key) {
  constexpr std::int32_t kBlockKeyMin = kKeyMin / kBlockEdge;
  if (std::min({key.x, key.y, key.z}) < kBlockKeyMin) return nullptr;
  const BlockOrdinal wanted = ordinal_of(key);
  const auto found = std::lower_bound(
      told.begin(), told.end(), wanted,
      [](const BlockDiff& diff, BlockOrdinal ordinal) { return diff.block < ordinal; });
  return found != told.end() && found->block == wanted ? &found->codes : nullptr;
}

PastNeighbours past_neighbours(std::span<const BlockDiff> told, BlockOrdinal block) {
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

bool claimed(const Claim& claim, const BlockDiff& diff) {
  return claim.keys.contains(diff.block) && claim.from < diff.changed_at &&
         diff.changed_at <= claim.to;
}

}  // namespace

PacketWriter::PacketWriter(const Claim& claim, std::size_t limit_bytes)
    : claim_(claim), coder_(diff_priors()) {
  assert(claim.valid());
  assert(limit_bytes >= kPacketBytesMin);
  constexpr std::size_t kEndMarkBytes = 2;
  body_bytes_max_ = limit_bytes - header_bytes_max(claim) - kEndMarkBytes;
}

bool PacketWriter::add(const BlockDiff& diff) {
  assert(claimed(claim_, diff));
  assert(told_.empty() || told_.back().block < diff.block);
  if (told_.size() == kBlocksPerPacketMax) return false;
  coder_.mark();
  code(diff, false);
  if (coder_.bytes_if_finished() > body_bytes_max_) {
    coder_.undo();
    if (!told_.empty()) return false;
    code(diff, true);
    assert(coder_.bytes_if_finished() <= body_bytes_max_);
  }
  told_.push_back(diff);
  return true;
}

DiffPacket PacketWriter::finish(BlockOrdinal end) {
  assert(told_.empty() || told_.back().block < end);
  coder_.bit(kMoreBlocks, false);
  claim_.keys.end = end;
  DiffPacket packet{claim_, write_header(claim_)};
  const std::vector<std::uint8_t> body = coder_.finish();
  packet.bytes.insert(packet.bytes.end(), body.begin(), body.end());
  return packet;
}

void PacketWriter::code(const BlockDiff& diff, bool raw) {
  BlockDiff written = diff;
  coder_.bit(kMoreBlocks, true);
  code_block_header(coder_, claim_, told_, written, raw);
  if (raw) {
    code_voxels_raw(coder_, written.codes);
  } else {
    code_voxels(coder_, past_neighbours(told_, diff.block), written.codes);
  }
}

tl::expected<std::vector<BlockDiff>, PacketError> read_blocks(
    const PacketHeader& header, std::span<const std::uint8_t> packet) {
  ModelDecoder coder(diff_priors(), packet.subspan(header.bytes));
  std::vector<BlockDiff> told;
  while (coder.bit(kMoreBlocks, false)) {
    if (told.size() == kBlocksPerPacketMax) return tl::unexpected(PacketError::kMalformed);
    BlockDiff diff;
    const bool raw = code_block_header(coder, header.claim, told, diff, false);
    if (coder.overrun() || !claimed(header.claim, diff)) {
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

}  // namespace warren
