// SPDX-License-Identifier: Apache-2.0
#include "core/layer/region_blocks.hpp"

#include <cassert>

#include "core/layer/diff_packet.hpp"

namespace warren {

LayerBlock& RegionBlocks::find_or_add(std::uint32_t place) {
  const std::size_t rank = rank_of(place);
  if (!has(place)) {
    // Grows by an eighth: blocks are most of what a layer takes.
    if (blocks_.size() == blocks_.capacity()) blocks_.reserve(blocks_.size() * 9 / 8 + 2);
    blocks_.emplace(blocks_.begin() + static_cast<std::ptrdiff_t>(rank));
    present_[place >> 6] |= std::uint64_t{1} << (place & 63);
  }
  return blocks_[rank];
}

void RegionBlocks::erase(std::uint32_t place) {
  if (!has(place)) return;
  blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(rank_of(place)));
  present_[place >> 6] &= ~(std::uint64_t{1} << (place & 63));
}

void RegionBlocks::drop_history(Revision until) {
  for (LayerBlock& block : blocks_) {
    if (block.history.latest() <= until) block.history.drop();
  }
}

std::size_t RegionBlocks::heap_bytes() const {
  std::size_t bytes = blocks_.capacity() * sizeof(LayerBlock);
  for (const LayerBlock& block : blocks_) {
    bytes += block.codes.heap_bytes() + block.history.heap_bytes();
  }
  return bytes;
}

std::size_t RegionBlocks::rank_of(std::uint32_t place) const {
  const std::size_t word = place >> 6;
  int rank = std::popcount(present_[word] & ((std::uint64_t{1} << (place & 63)) - 1));
  for (std::size_t before = 0; before < word; ++before) rank += std::popcount(present_[before]);
  return static_cast<std::size_t>(rank);
}

// The form is that of a packet, of any length, for one who holds nothing.
std::vector<std::uint8_t> RegionBlocks::packed(RegionOrdinal region, Revision latest) const {
  const KeyInterval keys = keys_of_region(region);
  PacketWriter writer({keys, Revision{}, latest}, kBlocksPerRegion * std::size_t{1024});
  for_each([&](std::uint32_t place, const LayerBlock& block) {
    const bool written =
        writer.add({keys.first | place, block.history.latest(), true, block.codes.unpack()});
    assert(written);
    return written;
  });
  std::vector<std::uint8_t> bytes = writer.finish(keys.end).bytes;
  bytes.shrink_to_fit();
  return bytes;
}

RegionBlocks RegionBlocks::unpacked(std::span<const std::uint8_t> bytes) {
  const auto header = read_header(bytes);
  assert(header);
  const auto diffs = read_blocks(*header, bytes);
  assert(diffs);
  RegionBlocks region;
  region.blocks_.reserve(diffs->size());
  for (const BlockDiff& diff : *diffs) {
    region.find_or_add(place_of(diff.block)) = {CodeBlock(diff.codes),
                                                ChangeHistory(diff.changed_at)};
  }
  return region;
}

}  // namespace warren
