// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/tile_grid.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace warren {
namespace {

constexpr std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1FFFFF;
  bits = (bits | bits << 32) & 0x1F00000000FFFFULL;
  bits = (bits | bits << 16) & 0x1F0000FF0000FFULL;
  bits = (bits | bits << 8) & 0x100F00F00F00F00FULL;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3ULL;
  return (bits | bits << 2) & 0x1249249249249249ULL;
}

constexpr std::uint32_t kBundleEdge = 4;
constexpr std::uint32_t kBundleShift = 2;

// Per axis, place of a tile in its bundle, and step to a bundle (-1, 0, 1): which places of that
// bundle are at most one tile away, as a mask of all 64.
using WindowMasks = std::array<std::array<std::array<std::uint64_t, 3>, kBundleEdge>, 3>;
constexpr WindowMasks window_masks() {
  WindowMasks masks{};
  for (std::uint32_t code = 0; code < 64; ++code) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t bits = code >> axis;
      const int place = static_cast<int>((bits & 1) | (bits >> 2 & 2));
      for (int from = 0; from < 4; ++from) {
        for (int step = -1; step <= 1; ++step) {
          const int apart = place + 4 * step - from;
          if (apart < -1 || apart > 1) continue;
          masks[axis][static_cast<std::size_t>(from)][static_cast<std::size_t>(step) + 1] |=
              std::uint64_t{1} << code;
        }
      }
    }
  }
  return masks;
}
constexpr WindowMasks kWindows = window_masks();

TilePlace bundle_of(const TilePlace& p) {
  return {p.x >> kBundleShift, p.y >> kBundleShift, p.z >> kBundleShift};
}

// Steps to the bundles that hold neighbours along one axis, first and last of -1, 0, 1.
struct Steps {
  int first = 0;
  int last = 0;
};
Steps steps_from(std::uint32_t place) {
  const std::uint32_t in_bundle = place % kBundleEdge;
  return {in_bundle == 0 ? -1 : 0, in_bundle == kBundleEdge - 1 ? 1 : 0};
}

std::uint64_t step_between(int x, int y, int z) {
  return static_cast<std::uint64_t>(x + y * (std::int64_t{1} << 21) + z * (std::int64_t{1} << 42));
}

std::uint64_t window(std::size_t axis, std::uint32_t place, int step) {
  return kWindows[axis][place % kBundleEdge][static_cast<std::size_t>(step) + 1];
}

// std::popcount is a call on baseline x86-64.
std::uint32_t bits_in(std::uint64_t mask) {
  mask -= mask >> 1 & 0x5555555555555555ULL;
  mask = (mask & 0x3333333333333333ULL) + (mask >> 2 & 0x3333333333333333ULL);
  mask = (mask + (mask >> 4)) & 0x0F0F0F0F0F0F0F0FULL;
  return static_cast<std::uint32_t>(mask * 0x0101010101010101ULL >> 56);
}

// Adds it in its place (insertion sort: they come nearly sorted), or to the one before it if they
// follow each other. Returns how many there are then.
std::size_t add_range(const PointRange& range, std::array<PointRange, 27>& ranges,
                      std::size_t count) {
  if (count > 0 && ranges[count - 1].end == range.first) {
    ranges[count - 1].end = range.end;
    return count;
  }
  std::size_t at = count;
  for (; at > 0 && ranges[at - 1].first > range.first; --at) ranges[at] = ranges[at - 1];
  ranges[at] = range;
  return count + 1;
}

}  // namespace

std::uint64_t morton_of(const TilePlace& place) {
  return spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2;
}

void TileTable::reset(std::size_t expected) {
  entries_.assign(std::bit_ceil(2 * expected + 2), Entry{});
  mask_ = entries_.size() - 1;
  shift_ = static_cast<unsigned>(64 - std::countr_zero(entries_.size()));
  used_ = 0;
}

std::uint32_t TileTable::find_or_add(std::uint64_t key, std::uint32_t fresh) {
  std::size_t i = start_of(key);
  while (entries_[i].key != key) {
    if (entries_[i].key == 0) {
      entries_[i] = {key, fresh};
      if (2 * ++used_ > entries_.size()) grow();
      return fresh;
    }
    i = (i + 1) & mask_;
  }
  return entries_[i].value;
}

void TileTable::grow() {
  spare_.assign(4 * entries_.size(), Entry{});
  std::swap(spare_, entries_);
  mask_ = entries_.size() - 1;
  shift_ = static_cast<unsigned>(64 - std::countr_zero(entries_.size()));
  used_ = 0;
  for (const Entry& entry : spare_) {
    if (entry.key != 0) find_or_add(entry.key, entry.value);
  }
}

void TileLevel::assign(std::vector<Tile>& tiles, float edge_m) {
  std::swap(tiles_, tiles);
  edge_m_ = edge_m;
  index_tiles();
}

void TileLevel::assign_parents_of(const TileLevel& finer) {
  edge_m_ = 2.0F * finer.edge_m_;
  tiles_.clear();
  for (const Tile& child : finer.tiles_) {
    const TilePlace place{child.place.x >> 1, child.place.y >> 1, child.place.z >> 1};
    if (tiles_.empty() || tiles_.back().place != place) {
      tiles_.push_back({place, child.points});
    } else {
      tiles_.back().points.end = child.points.end;
    }
  }
  index_tiles();
}

void TileLevel::index_tiles() {
  bundle_at_.reset(bundles_.size());
  bundles_.clear();
  std::uint64_t current = 0;  // no packed place is 0
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const std::uint64_t key = packed(bundle_of(tiles_[i].place));
    if (key != current) {
      bundle_at_.find_or_add(key, static_cast<std::uint32_t>(bundles_.size()));
      bundles_.push_back({0, static_cast<std::uint32_t>(i)});
      current = key;
    }
    bundles_.back().mask |= std::uint64_t{1} << (morton_of(tiles_[i].place) & 63);
  }
}

std::size_t TileLevel::neighbourhood(const Tile& tile, std::array<PointRange, 27>& around) const {
  const TilePlace& at = tile.place;
  const std::uint64_t centre = packed(bundle_of(at));
  const Steps xs = steps_from(at.x), ys = steps_from(at.y), zs = steps_from(at.z);
  std::size_t count = 0;
  for (int z = zs.first; z <= zs.last; ++z) {
    for (int y = ys.first; y <= ys.last; ++y) {
      for (int x = xs.first; x <= xs.last; ++x) {
        const std::uint32_t index = bundle_at_.find(centre + step_between(x, y, z));
        if (index == TileTable::kNone) continue;
        const Bundle& bundle = bundles_[index];
        std::uint64_t wanted =
            bundle.mask & window(0, at.x, x) & window(1, at.y, y) & window(2, at.z, z);
        for (; wanted != 0; wanted &= wanted - 1) {
          const std::uint64_t before = bundle.mask & ((wanted & -wanted) - 1);
          const auto rank = bits_in(before);
          count = add_range(tiles_[bundle.first_tile + rank].points, around, count);
        }
      }
    }
  }
  return count;
}

}  // namespace warren
