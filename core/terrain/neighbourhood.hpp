// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/terrain/candidate_gatherer.hpp"
#include "core/terrain/cloud_reduction.hpp"
#include "core/terrain/neighbour_kernel.hpp"
#include "core/terrain/tile_grid.hpp"

namespace warren {

struct NeighbourhoodConfig {
  std::uint32_t neighbours = 24;  // the point itself included
  // A neighbourhood that reaches farther is too wide, and not looked for; none: any width will do.
  std::optional<float> max_radius_m;
};

enum class NeighbourhoodState : std::uint8_t {
  kFound,
  kTooFew,   // the whole cloud has fewer points
  kTooWide,  // the k-th nearest is farther than the maximum radius
};

// Per point of the cloud: sums over the offsets of its nearest from itself. Moments are in the
// order of NearestSums; each array has kVectorPadding more values.
struct Neighbourhoods {
  std::array<std::vector<float>, 9> moments;
  std::vector<float> squared_radius;
  std::vector<NeighbourhoodState> states;
};

// The exact k nearest neighbours of every point: by squared distance in single precision, then by
// place in the cloud. Looks through the tiles around a point, and through larger ones only where
// the k-th could lie outside of these. Reuses buffers.
class NeighbourSearch {
 public:
  explicit NeighbourSearch(const NeighbourhoodConfig& config);

  // Lives until the next call.
  const Neighbourhoods& find(const ReducedCloud& cloud);
  // Indices of the nearest of every point, ascending, k per point; a point without neighbourhood
  // has its own index k times. For those who want to see them.
  std::vector<std::uint32_t> list(const ReducedCloud& cloud);

 private:
  void search(const ReducedCloud& cloud, std::span<std::uint32_t> listed);
  void search_level(const ReducedCloud& cloud, const TileLevel& level,
                    std::span<std::uint32_t> listed);
  void search_tile(const ReducedCloud& cloud, const TileLevel& level, const Tile& tile,
                   std::span<const std::uint32_t> queries, std::span<std::uint32_t> listed);
  bool covers_max_radius(const TileLevel& level) const;
  void leave(std::span<const std::uint32_t> queries, float covered_m, bool whole_cloud);
  void settle(std::uint32_t index, const NearestSums& sums, float covered_m);
  void list_one(const Candidates& candidates, std::span<const PointRange> around,
                const NearestQuery& query, std::span<std::uint32_t> indices);

  NeighbourhoodConfig config_;
  float max_squared_;
  float margin_m_ = 0.0F;  // what rounding may move a point out of its tile
  Neighbourhoods found_;
  std::vector<std::uint32_t> pending_;  // ascending
  std::vector<std::uint32_t> postponed_;
  std::array<TileLevel, 2> coarser_;
  CandidateGatherer gatherer_;
  NearCandidates near_;
};

}  // namespace warren
