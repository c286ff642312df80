// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/neighbourhood.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace warren {
namespace {

constexpr float kEverywhere = std::numeric_limits<float>::infinity();
// With fewer candidates than this many times k, the k-th is seldom surely found: better to look
// through larger tiles at once.
constexpr std::size_t kWorthASearch = 2;
// Nor are tiles searched whose family of eight holds less than so many tenths of k: on a surface
// some four of the eight are in it, and nine around a tile have to hold k well within reach.
constexpr std::size_t kSparseFamilyTenths = 8;
// The radius changes little from one point to the next: this much more nearly always holds k.
constexpr float kGuessGrowth = 1.3F;

// The box of a tile, from the lowest point on.
struct Box {
  Point3f low;
  float edge_m = 0.0F;
};

Box box_of(const Tile& tile, float edge_m, float finest_edge_m) {
  const float low_m = static_cast<float>(kCellLimit) * finest_edge_m / kTileCells;
  const auto corner = [&](std::uint32_t place) {
    return static_cast<float>(place) * edge_m - low_m;
  };
  return {{corner(tile.place.x), corner(tile.place.y), corner(tile.place.z)}, edge_m};
}

// From a point in the box to its nearest face.
float to_face_m(const Box& box, const Point3f& p) {
  const Point3f in{p.x - box.low.x, p.y - box.low.y, p.z - box.low.z};
  const float low = std::min({in.x, in.y, in.z});
  const float high = std::max({in.x, in.y, in.z});
  return std::max(0.0F, std::min(low, box.edge_m - high));
}

// One past the last of the tiles that will be one tile in the next level.
std::size_t end_of_siblings(std::span<const Tile> tiles, std::size_t first) {
  const auto parent_of = [](const TilePlace& p) { return TilePlace{p.x >> 1, p.y >> 1, p.z >> 1}; };
  const TilePlace parent = parent_of(tiles[first].place);
  std::size_t end = first + 1;
  while (end < tiles.size() && parent_of(tiles[end].place) == parent) ++end;
  return end;
}

float largest_coordinate(const ReducedCloud& cloud) {
  float largest = 0.0F;
  for (const auto* axis : {&cloud.x, &cloud.y, &cloud.z}) {
    for (const float value : *axis) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

}  // namespace

NeighbourSearch::NeighbourSearch(const NeighbourhoodConfig& config)
    : config_(config),
      max_squared_(config.max_radius_m ? *config.max_radius_m * *config.max_radius_m
                                       : kEverywhere) {
  assert(config.neighbours > 0);
}

const Neighbourhoods& NeighbourSearch::find(const ReducedCloud& cloud) {
  search(cloud, {});
  return found_;
}

std::vector<std::uint32_t> NeighbourSearch::list(const ReducedCloud& cloud) {
  std::vector<std::uint32_t> listed(cloud.size() * config_.neighbours);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    listed[i] = static_cast<std::uint32_t>(i / config_.neighbours);
  }
  search(cloud, listed);
  return listed;
}

void NeighbourSearch::search(const ReducedCloud& cloud, std::span<std::uint32_t> listed) {
  for (auto& moment : found_.moments) moment.resize(cloud.size() + kVectorPadding);
  found_.squared_radius.resize(cloud.size() + kVectorPadding);
  found_.states.assign(cloud.size(), NeighbourhoodState::kTooFew);
  margin_m_ = 4e-6F * largest_coordinate(cloud) + 1e-6F;
  pending_.resize(cloud.size());
  std::iota(pending_.begin(), pending_.end(), 0U);

  const TileLevel* level = &cloud.tiles;
  for (std::size_t depth = 0; !pending_.empty(); ++depth) {
    postponed_.clear();
    search_level(cloud, *level, listed);
    std::swap(pending_, postponed_);
    if (pending_.empty()) return;
    TileLevel& coarser = coarser_[depth % 2];
    coarser.assign_parents_of(*level);
    level = &coarser;
  }
}

void NeighbourSearch::search_level(const ReducedCloud& cloud, const TileLevel& level,
                                   std::span<std::uint32_t> listed) {
  const std::span<const Tile> tiles = level.tiles();
  const std::span<const std::uint32_t> pending(pending_);
  // Where a maximum radius will be covered by this level, no larger tiles are to come.
  const bool may_postpone = tiles.size() > 1 && !covers_max_radius(level);
  std::size_t next = 0;
  const auto take_pending_in = [&](const PointRange& range) {
    const std::size_t first = next;
    while (next < pending.size() && pending[next] < range.end) ++next;
    return pending.subspan(first, next - first);
  };
  for (std::size_t i = 0; i < tiles.size();) {
    const std::size_t end = end_of_siblings(tiles, i);
    const PointRange family{tiles[i].points.first, tiles[end - 1].points.end};
    if (may_postpone && 10 * family.size() < kSparseFamilyTenths * config_.neighbours) {
      const auto queries = take_pending_in(family);
      postponed_.insert(postponed_.end(), queries.begin(), queries.end());
    } else {
      for (const Tile& tile : tiles.subspan(i, end - i)) {
        const auto queries = take_pending_in(tile.points);
        if (!queries.empty()) search_tile(cloud, level, tile, queries, listed);
      }
    }
    i = end;
  }
}

bool NeighbourSearch::covers_max_radius(const TileLevel& level) const {
  const float edge_m = level.edge_m() - margin_m_;
  return edge_m > 0.0F && edge_m * edge_m > max_squared_;
}

void NeighbourSearch::search_tile(const ReducedCloud& cloud, const TileLevel& level,
                                  const Tile& tile, std::span<const std::uint32_t> queries,
                                  std::span<std::uint32_t> listed) {
  std::array<PointRange, 27> ranges;
  const std::span<const PointRange> around(ranges.data(), level.neighbourhood(tile, ranges));
  const auto count =
      std::accumulate(around.begin(), around.end(), std::size_t{0},
                      [](std::size_t sum, const PointRange& r) { return sum + r.size(); });
  const bool whole_cloud = count == cloud.size();
  const float edge_m = level.edge_m() - margin_m_;
  const bool last_chance = whole_cloud || covers_max_radius(level);
  const std::size_t k = config_.neighbours;
  if (count < k || (count < kWorthASearch * k && !last_chance)) {
    return leave(queries, edge_m, whole_cloud);
  }
  const Candidates candidates = gatherer_.gather(cloud, around);
  near_.reserve(candidates.count);
  const Box box = box_of(tile, level.edge_m(), cloud.tiles.edge_m());
  NearestQuery query{cloud.point(queries.front()), k, edge_m * edge_m};
  for (const std::uint32_t index : queries) {
    const Point3f centre = cloud.point(index);
    query.centre = centre;
    const NearestSums sums = find_nearest(candidates, query, near_);
    const float covered_m = whole_cloud ? kEverywhere : edge_m + to_face_m(box, centre);
    settle(index, sums, covered_m);
    if (!listed.empty() && found_.states[index] == NeighbourhoodState::kFound) {
      list_one(candidates, around, query, listed.subspan(index * k, k));
    }
    query.guess = sums.squared_radius * kGuessGrowth;
  }
}

// No search here: for larger tiles to find, unless there are none or they would be too large.
void NeighbourSearch::leave(std::span<const std::uint32_t> queries, float covered_m,
                            bool whole_cloud) {
  const bool too_wide = covered_m > 0.0F && covered_m * covered_m > max_squared_;
  for (const std::uint32_t index : queries) {
    if (whole_cloud) {
      found_.states[index] = NeighbourhoodState::kTooFew;
    } else if (too_wide) {
      found_.states[index] = NeighbourhoodState::kTooWide;
    } else {
      postponed_.push_back(index);
    }
  }
}

void NeighbourSearch::settle(std::uint32_t index, const NearestSums& sums, float covered_m) {
  const float covered_squared = covered_m * covered_m;
  if (sums.squared_radius > std::min(covered_squared, max_squared_)) {
    if (covered_squared > max_squared_) {
      found_.states[index] = NeighbourhoodState::kTooWide;
    } else {
      postponed_.push_back(index);
    }
    return;
  }
  for (std::size_t i = 0; i < sums.moments.size(); ++i) {
    found_.moments[i][index] = sums.moments[i];
  }
  found_.squared_radius[index] = sums.squared_radius;
  found_.states[index] = NeighbourhoodState::kFound;
}

void NeighbourSearch::list_one(const Candidates& candidates, std::span<const PointRange> around,
                               const NearestQuery& query, std::span<std::uint32_t> indices) {
  list_nearest(candidates, query, near_, indices);
  const PointRange* range = around.data();
  std::uint32_t before = 0;  // candidates in earlier ranges
  for (std::uint32_t& index : indices) {
    while (index - before >= range->size()) {
      before += static_cast<std::uint32_t>(range->size());
      ++range;
    }
    index = range->first + (index - before);
  }
}

}  // namespace warren
