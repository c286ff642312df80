// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/voxel/scan.hpp"
#include "daemon/control/request.hpp"
#include "daemon/fleet/block_feed.hpp"

namespace warren {

// What a copy of a map lacks, or a part of it. Bounded, whatever the copy lacks.
struct BlocksAnswer {
  // Bounds the time that an answer takes on the fleet thread, which may have to derive each block.
  static constexpr std::size_t kBlocksMax = 1024;

  double resolution_m = 0.0;
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  // lowest corner of block (0, 0, 0)
  Pose T_fleet_map;
  std::optional<Eigen::Vector3d> position_map;  // of the sensor, at the scan taken last
  bool anew = false;                            // what the copy holds is void
  BlocksCursor cursor;
  std::vector<BlockKey> keys;
  std::string codes;  // append_runs() of each

  // The copy may lack more than this.
  bool is_part() const { return !cursor.is_through(); }
  bool is_news() const { return anew || !keys.empty() || is_part(); }
};

// The blocks that a box touches in a map of this resolution whose key (0, 0, 0) lies there in the
// map frame; those of the key space if there is no box.
BlockBox blocks_in(const std::optional<MapBox>& box, double resolution_m,
                   const Eigen::Vector3d& origin_map);

// The next part of what the copy lacks: goes on with its sweep, or begins one. Numbers and keys of
// another frame than `frame` mean nothing, the copy then begins anew.
void tell_blocks(BlockFeed& feed, std::uint64_t frame, const BlockBox& box,
                 const BlocksQuestion& question, BlocksAnswer& answer);

}  // namespace warren
