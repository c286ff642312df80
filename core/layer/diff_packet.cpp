// SPDX-License-Identifier: Apache-2.0
#include "core/layer/diff_packet.hpp"

#include <cassert>

#include "core/layer/packet_body.hpp"

namespace warren {

PacketWriter::PacketWriter(const Claim& claim, std::size_t limit_bytes)
    : claim_(claim), coder_(diff_priors()) {
  assert(claim.valid());
  assert(limit_bytes >= kPacketBytesMin);
  constexpr std::size_t kEndMarkBytes = 2;
  body_bytes_max_ = limit_bytes - header_bytes_max(claim) - kEndMarkBytes;
}

bool PacketWriter::add(const BlockDiff& diff) {
  assert(packet_body::claimed(claim_, diff));
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
  coder_.bit(diff_context::kMoreBlocks, false);
  claim_.keys.end = end;
  DiffPacket packet{claim_, write_header(claim_)};
  const std::vector<std::uint8_t> body = coder_.finish();
  packet.bytes.insert(packet.bytes.end(), body.begin(), body.end());
  return packet;
}

void PacketWriter::code(const BlockDiff& diff, bool raw) {
  BlockDiff written = diff;
  coder_.bit(diff_context::kMoreBlocks, true);
  packet_body::code_block_header(coder_, claim_, told_, written, raw);
  if (raw) {
    code_voxels_raw(coder_, written.codes);
  } else {
    code_voxels(coder_, packet_body::past_neighbours(told_, diff.block), written.codes);
  }
}

tl::expected<std::vector<BlockDiff>, PacketError> read_blocks(
    const PacketHeader& header, std::span<const std::uint8_t> packet) {
  ModelDecoder coder(diff_priors(), packet.subspan(header.bytes));
  return packet_body::read_body(coder, header.claim);
}

}  // namespace warren
