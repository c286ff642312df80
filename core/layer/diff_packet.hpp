// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "core/layer/block_codec.hpp"
#include "core/layer/packet_header.hpp"

namespace warren {

// A packet is decoded alone, into at most so many blocks.
inline constexpr std::size_t kBlocksPerPacketMax = 1024;
// Any block fits into a packet of this size.
inline constexpr std::size_t kPacketBytesMin = 440;

struct DiffPacket {
  Claim claim;
  std::vector<std::uint8_t> bytes;
};

// Fills one packet, block by block in key order, up to a limit of bytes.
class PacketWriter {
 public:
  // `claim.keys.end` may still be lowered by finish(). Preconditions: the claim is valid, the limit
  // at least kPacketBytesMin.
  PacketWriter(const Claim& claim, std::size_t limit_bytes);

  // False, and nothing is written, when the packet is full. Never on the first call. Preconditions:
  // diff.block rises from call to call and is claimed, as is diff.changed_at.
  bool add(const BlockDiff& diff);
  std::size_t blocks() const { return told_.size(); }

  // Claims the keys up to `end`, which is above all blocks added. The writer is spent.
  DiffPacket finish(BlockOrdinal end);

 private:
  void code(const BlockDiff& diff, bool raw);

  Claim claim_;
  std::size_t body_bytes_max_ = 0;  // without the mark that ends it
  ModelEncoder coder_;
  std::vector<BlockDiff> told_;
};

// The blocks of a packet whose header has been read, in key order; kMalformed if the bytes are none
// that a writer makes. Bounded in time and memory on any input.
tl::expected<std::vector<BlockDiff>, PacketError> read_blocks(const PacketHeader& header,
                                                              std::span<const std::uint8_t> packet);

}  // namespace warren
