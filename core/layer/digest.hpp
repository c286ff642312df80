// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"

namespace warren {

// BLAKE2b-256.
using Hash = std::array<std::uint8_t, 32>;

// A hash tree over the keys and codes of a layer's blocks: blocks in key order make a region's
// hash, regions in key order the root. Empty blocks and history leave no trace, so equal roots
// prove equal maps, however each came about.
class LayerDigest {
 public:
  struct Entry {
    std::uint64_t ordinal = 0;  // of the region or block
    Hash hash{};
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  // The block's codes are these from now on.
  void update(BlockOrdinal block, const CodeBlock& codes);
  // These blocks are empty from now on.
  void erase(const KeyInterval& keys);

  Hash root() const;
  // All regions, and the blocks of one of them, in key order. Precondition of blocks_of: the region
  // is awake.
  std::vector<Entry> regions() const;
  std::vector<Entry> blocks_of(RegionOrdinal region) const;

  // Keeps of a region nothing but its hash, until all its blocks are told again. In between its
  // blocks may be erased all at once, but not changed.
  void rest(RegionOrdinal region);
  void wake(RegionOrdinal region, std::vector<Entry> blocks);

  std::size_t memory_bytes() const;

 private:
  struct Region {
    std::vector<Entry> blocks;
    mutable std::optional<Hash> hash;  // none: to be computed

    bool rests() const { return blocks.empty(); }
  };

  static const Hash& hash_of(RegionOrdinal ordinal, const Region& region);

  std::map<RegionOrdinal, Region> regions_;
  mutable std::optional<Hash> root_;
};

// What block entries of a digest hold; for empty codes there is no entry.
Hash hash_of(BlockOrdinal block, const CodeBlock& codes);
// Of any bytes; never that of a node of a digest.
Hash hash_of_bytes(std::span<const std::uint8_t> bytes);

// The ordinals that stand with another hash, or only, in one of the lists. Preconditions: each list
// is in rising order.
std::vector<std::uint64_t> differing(std::span<const LayerDigest::Entry> a,
                                     std::span<const LayerDigest::Entry> b);

}  // namespace warren
