// SPDX-License-Identifier: Apache-2.0
#include "core/layer/publisher.hpp"

#include <utility>

#include "core/voxel/bits.hpp"

namespace warren {
namespace {

// The 2x2x2 cubes of a cell, each one byte of it, all of whose voxels are in the mask.
std::uint64_t whole_cubes(std::uint64_t cell) {
  std::uint64_t whole = 0;
  for (int shift = 0; shift < 64; shift += 8) {
    const std::uint64_t cube = std::uint64_t{0xFF} << shift;
    if ((cell & cube) == cube) whole |= cube;
  }
  return whole;
}

bool is_small_change(CostCode before, CostCode now) {
  if (before == now || before == kNoCostData || now == kNoCostData) return false;
  const bool one_bin_off = before + 1 == now || now + 1 == before;
  return one_bin_off && is_safe(before, kSafeMeanCost) == is_safe(now, kSafeMeanCost) &&
         is_safe(before, kSafeMostCost) == is_safe(now, kSafeMostCost);
}

std::uint64_t ragged_free(const BlockCodes& exact, const BlockCodes& published, std::size_t cell) {
  const std::uint64_t newly_free =
      exact.known[cell] & ~exact.occupied[cell] & ~published.known[cell];
  return newly_free & ~whole_cubes(exact.known[cell]);
}

std::uint64_t small_cost_changes(const BlockCodes& exact, const BlockCodes& published,
                                 std::size_t cell) {
  std::uint64_t small = 0;
  const std::uint64_t same_but_cost = exact.occupied[cell] & published.occupied[cell] &
                                      ~(exact.stairs[cell] ^ published.stairs[cell]);
  for_each_bit(same_but_cost, [&](std::uint32_t bit) {
    const std::size_t place = cell << 6 | bit;
    if (is_small_change(published.costs[place], exact.costs[place]))
      small |= std::uint64_t{1} << bit;
  });
  return small;
}

void keep_as_published(BlockCodes& codes, const BlockCodes& published, std::size_t cell,
                       std::uint64_t waits) {
  for_each_bit(waits, [&](std::uint32_t bit) {
    const auto place = static_cast<std::uint32_t>(cell << 6 | bit);
    codes.set(place, published.at(place));
  });
}

struct Shown {
  CodeBlock codes;
  bool holds_back = false;
};

Shown shown_of(const CodeBlock& exact_codes, const CodeBlock& published_codes,
               const SenderRules& rules) {
  const BlockCodes exact = exact_codes.unpack();
  const BlockCodes published = published_codes.unpack();
  BlockCodes shown = exact;
  bool holds_back = false;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    std::uint64_t waits = 0;
    if (rules.hold_ragged_free) waits |= ragged_free(exact, published, cell);
    if (rules.hold_small_cost_changes) waits |= small_cost_changes(exact, published, cell);
    keep_as_published(shown, published, cell, waits);
    holds_back |= waits != 0;
  }
  return {holds_back ? CodeBlock(shown) : exact_codes, holds_back};
}

}  // namespace

CodeBlock codes_of(const SelfMap& map, const BlockKey& key) {
  const BlockStore& store = map.blocks();
  const BlockSlot slot = store.slot_of(key);
  BlockCodes codes;
  if (slot == kAbsentBlock) return {};
  if (slot == kFreeBlock) {
    codes.known.fill(kFullCell);
    return CodeBlock(codes);
  }
  const Block& block = store.block(slot);
  codes.known = block.known;
  codes.occupied = block.occupied;
  for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(block.occupied[cell], [&](std::uint32_t bit) {
      const std::uint32_t place = cell << 6 | bit;
      codes.costs[place] = encode_cost(store.cost(block, place));
    });
  }
  return CodeBlock(codes);
}

std::vector<CodedBlock> blocks_changed_since(const SelfMap& map, std::uint32_t cursor) {
  const std::vector<BlockKey> keys = map.blocks_changed_since(cursor);
  std::vector<CodedBlock> changed;
  changed.reserve(keys.size());
  for (const BlockKey& key : keys) changed.push_back({ordinal_of(key), codes_of(map, key)});
  return changed;
}

std::vector<CodedBlock> Publisher::tick(std::span<const CodedBlock> now, const Replica& published) {
  std::vector<CodedBlock> changed;
  for (const auto& [block, exact] : now) {
    const CodeBlock& before = published.codes_in_place(block);
    Shown shown = shown_of(exact, before, rules_);
    if (shown.holds_back) {
      held_back_.insert_or_assign(block, exact);
    } else {
      held_back_.erase(block);
    }
    if (shown.codes != before) changed.push_back({block, std::move(shown.codes)});
  }
  return changed;
}

std::vector<CodedBlock> Publisher::flush(const Replica& published) {
  std::vector<CodedBlock> changed;
  for (auto& [block, exact] : std::exchange(held_back_, {})) {
    if (published.codes_in_place(block) != exact) changed.push_back({block, exact});
  }
  return changed;
}

std::size_t Publisher::memory_bytes() const {
  std::size_t bytes = 0;
  // A node of a tree has 32 bytes of its own.
  for (const auto& entry : held_back_) bytes += 32 + sizeof(entry) + entry.second.heap_bytes();
  return bytes;
}

}  // namespace warren
