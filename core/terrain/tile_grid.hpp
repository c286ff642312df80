// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace warren {

// The cells of a reduction lie within so many of the layer's origin, per axis: 52 km at 5 cm.
inline constexpr std::int32_t kCellLimit = 1 << 20;
// Edge of a tile of the finest level, in cells. Three by three tiles of a surface then hold the
// 24 nearest of every point in the middle one, with few others.
inline constexpr std::uint32_t kTileCells = 4;

// Counted from the low corner of the cell space, so never negative.
struct TilePlace {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t z = 0;
  friend auto operator<=>(const TilePlace&, const TilePlace&) = default;
};

// Points that lie together in their cloud.
struct PointRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;

  std::size_t size() const { return end - first; }
};

// A cube of space and the points in it.
struct Tile {
  TilePlace place;
  PointRange points;
};

// Places as one number, in which a step to a neighbour is one addition. One is added per axis so
// that a step down from 0 borrows from nobody.
constexpr std::uint64_t packed(const TilePlace& p) {
  return (p.x + std::uint64_t{1}) | (p.y + std::uint64_t{1}) << 21 | (p.z + std::uint64_t{1}) << 42;
}
std::uint64_t morton_of(const TilePlace& place);

// Open addressing from a packed place to a number; empty again in one fill.
class TileTable {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // Room for so many before it grows.
  void reset(std::size_t expected);
  // The value of the key; kNone if it has none.
  std::uint32_t find(std::uint64_t key) const {
    std::size_t i = start_of(key);
    while (entries_[i].key != key && entries_[i].key != 0) i = (i + 1) & mask_;
    return entries_[i].key == key ? entries_[i].value : kNone;
  }
  // Adds it with `fresh` if it is new.
  std::uint32_t find_or_add(std::uint64_t key, std::uint32_t fresh);

 private:
  struct Entry {
    std::uint64_t key = 0;  // 0: empty; no packed place is 0
    std::uint32_t value = kNone;
  };

  std::size_t start_of(std::uint64_t key) const {
    return static_cast<std::size_t>(key * 0x9E3779B97F4A7C15ULL >> shift_);
  }
  void grow();

  std::vector<Entry> entries_ = std::vector<Entry>(2);
  std::vector<Entry> spare_;  // memory to grow into
  std::size_t mask_ = 1;
  unsigned shift_ = 63;
  std::size_t used_ = 0;
};

// Tiles of one size in Morton order, and which one lies where: 64 tiles that fill a cube of 4x4x4
// are a bundle, in which a mask and a count of its bits find a tile.
class TileLevel {
 public:
  std::span<const Tile> tiles() const { return tiles_; }
  float edge_m() const { return edge_m_; }

  // Swaps in tiles that are in Morton order.
  void assign(std::vector<Tile>& tiles, float edge_m);
  // The level of tiles twice as large.
  void assign_parents_of(const TileLevel& finer);

  // The points of the tile and of its 26 neighbours, as ranges in ascending order; returns how
  // many ranges there are.
  std::size_t neighbourhood(const Tile& tile, std::array<PointRange, 27>& around) const;

 private:
  struct Bundle {
    std::uint64_t mask = 0;        // by Morton code of the tile's place in the bundle
    std::uint32_t first_tile = 0;  // which follow each other in the order of the mask
  };

  void index_tiles();

  std::vector<Tile> tiles_;
  std::vector<Bundle> bundles_;
  TileTable bundle_at_;
  float edge_m_ = 0.0F;
};

}  // namespace warren
