// SPDX-License-Identifier: Apache-2.0
#include "core/layer/digest.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include <sodium.h>

namespace warren {
namespace {

// What is hashed begins with the level it belongs to, lest a node pass for one of another level.
enum class Level : std::uint8_t { kBlock, kRegion, kRoot, kBytes };

class Hasher {
 public:
  explicit Hasher(Level level) {
    [[maybe_unused]] static const int kReady = sodium_init();
    assert(kReady >= 0);
    crypto_generichash_init(&state_, nullptr, 0, sizeof(Hash));
    add(std::array{static_cast<std::uint8_t>(level)});
  }

  void add(std::span<const std::uint8_t> bytes) {
    crypto_generichash_update(&state_, bytes.data(), bytes.size());
  }
  void add(std::uint64_t number) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(number >> 8 * i);
    }
    add(bytes);
  }
  void add(std::span<const LayerDigest::Entry> entries) {
    for (const auto& [ordinal, hash] : entries) {
      add(ordinal);
      add(hash);
    }
  }

  Hash finish() {
    Hash hash{};
    crypto_generichash_final(&state_, hash.data(), hash.size());
    return hash;
  }

 private:
  crypto_generichash_state state_{};
};

auto find_block(std::vector<LayerDigest::Entry>& blocks, BlockOrdinal block) {
  return std::lower_bound(
      blocks.begin(), blocks.end(), block,
      [](const LayerDigest::Entry& entry, BlockOrdinal wanted) { return entry.ordinal < wanted; });
}

// Grows by an eighth: a layer holds one entry per block.
auto insert_sparingly(std::vector<LayerDigest::Entry>& blocks,
                      std::vector<LayerDigest::Entry>::iterator place,
                      const LayerDigest::Entry& entry) {
  const auto index = place - blocks.begin();
  if (blocks.size() == blocks.capacity()) blocks.reserve(blocks.size() + blocks.size() / 8 + 4);
  return blocks.insert(blocks.begin() + index, entry);
}

}  // namespace

Hash hash_of(BlockOrdinal block, const CodeBlock& codes) {
  Hasher hasher(Level::kBlock);
  hasher.add(block);
  for (const std::uint64_t cell : codes.known()) hasher.add(cell);
  for (const std::uint64_t cell : codes.occupied()) hasher.add(cell);
  hasher.add(codes.attributes());
  return hasher.finish();
}

Hash hash_of_bytes(std::span<const std::uint8_t> bytes) {
  Hasher hasher(Level::kBytes);
  hasher.add(bytes);
  return hasher.finish();
}

void LayerDigest::update(BlockOrdinal block, const CodeBlock& codes) {
  if (codes.empty()) return erase({block, block + 1});
  const auto [entry, is_new] = regions_.try_emplace(region_of(block));
  Region& region = entry->second;
  assert(is_new || !region.rests());
  auto place = find_block(region.blocks, block);
  if (place == region.blocks.end() || place->ordinal != block) {
    place = insert_sparingly(region.blocks, place, {block, {}});
  }
  place->hash = warren::hash_of(block, codes);
  region.hash.reset();
  root_.reset();
}

void LayerDigest::erase(const KeyInterval& keys) {
  auto entry = regions_.lower_bound(keys.first >> 9);
  while (entry != regions_.end() && entry->first << 9 < keys.end) {
    auto& [ordinal, region] = *entry;
    assert(!region.rests() || (keys.first <= ordinal << 9 && (ordinal + 1) << 9 <= keys.end));
    region.blocks.erase(find_block(region.blocks, keys.first), find_block(region.blocks, keys.end));
    region.hash.reset();
    entry = region.blocks.empty() ? regions_.erase(entry) : std::next(entry);
  }
  root_.reset();
}

Hash LayerDigest::root() const {
  if (!root_) {
    Hasher hasher(Level::kRoot);
    hasher.add(regions());
    root_ = hasher.finish();
  }
  return *root_;
}

std::vector<LayerDigest::Entry> LayerDigest::regions() const {
  std::vector<Entry> entries;
  entries.reserve(regions_.size());
  for (const auto& [ordinal, region] : regions_) {
    entries.push_back({ordinal, hash_of(ordinal, region)});
  }
  return entries;
}

std::vector<LayerDigest::Entry> LayerDigest::blocks_of(RegionOrdinal region) const {
  const auto found = regions_.find(region);
  if (found == regions_.end()) return {};
  assert(!found->second.rests());
  return found->second.blocks;
}

void LayerDigest::rest(RegionOrdinal region) {
  const auto found = regions_.find(region);
  if (found == regions_.end()) return;
  hash_of(found->first, found->second);
  found->second.blocks = std::vector<Entry>();
}

void LayerDigest::wake(RegionOrdinal region, std::vector<Entry> blocks) {
  const auto found = regions_.find(region);
  if (found == regions_.end()) return;
  assert(found->second.rests());
  found->second.blocks = std::move(blocks);
}

std::size_t LayerDigest::memory_bytes() const {
  // A node of the tree has 32 bytes of its own.
  std::size_t bytes = regions_.size() * (32 + sizeof(*regions_.begin()));
  for (const auto& [ordinal, region] : regions_) bytes += region.blocks.capacity() * sizeof(Entry);
  return bytes;
}

const Hash& LayerDigest::hash_of(RegionOrdinal ordinal, const Region& region) {
  if (!region.hash) {
    Hasher hasher(Level::kRegion);
    hasher.add(ordinal);
    hasher.add(region.blocks);
    region.hash = hasher.finish();
  }
  return *region.hash;
}

std::vector<std::uint64_t> differing(std::span<const LayerDigest::Entry> a,
                                     std::span<const LayerDigest::Entry> b) {
  std::vector<std::uint64_t> ordinals;
  while (!a.empty() || !b.empty()) {
    const bool from_a = !a.empty() && (b.empty() || a[0].ordinal <= b[0].ordinal);
    const bool from_b = !b.empty() && (a.empty() || b[0].ordinal <= a[0].ordinal);
    const bool equal = from_a && from_b && a[0].hash == b[0].hash;
    if (!equal) ordinals.push_back(from_a ? a[0].ordinal : b[0].ordinal);
    if (from_a) a = a.subspan(1);
    if (from_b) b = b.subspan(1);
  }
  return ordinals;
}

}  // namespace warren
