// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/layer/change_history.hpp"
#include "core/layer/claim.hpp"
#include "core/layer/code_block.hpp"

namespace warren {

// A block that was emptied stays, with no codes, because others are still to be told.
struct LayerBlock {
  CodeBlock codes;
  ChangeHistory history;
};

// The blocks of one region by their place in it, 0 to 511 in key order.
class RegionBlocks {
 public:
  static constexpr std::uint32_t place_of(BlockOrdinal block) {
    return static_cast<std::uint32_t>(block & 511);
  }

  bool empty() const { return blocks_.empty(); }
  std::size_t size() const { return blocks_.size(); }
  // Null if there is none. Valid until a block is added or erased.
  const LayerBlock* find(std::uint32_t place) const {
    return has(place) ? &blocks_[rank_of(place)] : nullptr;
  }
  LayerBlock& find_or_add(std::uint32_t place);
  void erase(std::uint32_t place);
  void drop_history(Revision until);

  // Calls visit(place, const LayerBlock&) in order as long as it returns true; whether it always
  // did.
  template <typename Visit>
  bool for_each(Visit&& visit) const;

  std::size_t heap_bytes() const;

  // All blocks and their latest changes as bytes; who changed which voxel when is lost. `latest` is
  // the latest change of any block.
  std::vector<std::uint8_t> packed(RegionOrdinal region, Revision latest) const;
  // Precondition: packed() made the bytes.
  static RegionBlocks unpacked(std::span<const std::uint8_t> bytes);

 private:
  bool has(std::uint32_t place) const { return (present_[place >> 6] >> (place & 63) & 1) != 0; }
  std::size_t rank_of(std::uint32_t place) const;

  std::array<std::uint64_t, 8> present_{};
  std::vector<LayerBlock> blocks_;  // in bit order
};

template <typename Visit>
bool RegionBlocks::for_each(Visit&& visit) const {
  std::size_t rank = 0;
  for (std::uint32_t word = 0; word < present_.size(); ++word) {
    for (std::uint64_t bits = present_[word]; bits != 0; bits &= bits - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (!visit(word << 6 | bit, blocks_[rank++])) return false;
    }
  }
  return true;
}

}  // namespace warren
