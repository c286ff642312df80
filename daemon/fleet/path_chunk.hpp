// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/layer/claim.hpp"
#include "daemon/replication/item.hpp"

namespace warren {

struct PathPoint {
  std::int64_t time_us = 0;  // since 1970, by the robot's clock; on the wire whole milliseconds
  Eigen::Vector3d position_layer = Eigen::Vector3d::Zero();  // on the wire whole centimetres
};

// A part of the path of a robot's sensor in one of its layers, as a trajectory item of its log. The
// item's bytes:
//   kind, version  1 byte  0x34
//   layer          16      origin, number, incarnation
//   number         LEB128  of the part in the layer, from 0
//   points         LEB128  1 to kPointsMax
//   each point             milliseconds (of the first since 1970, else since the one before) and
//                          x y z, centimetres (likewise in the layer's frame): LEB128, signed ones
//                          as 2n, or -2n - 1 if n < 0
// Its name: 't', layer, number (4 bytes): a part that grows replaces its former self.
struct PathChunk {
  static constexpr std::uint8_t kKind = 0x34;
  static constexpr std::size_t kPointsMax = 64;

  LayerId layer;
  std::uint32_t number = 0;
  std::vector<PathPoint> points;  // times do not go back
};

// Precondition: 1 to kPointsMax points, each within kPathReach_m.
replication::Item item_of(const PathChunk& chunk);
// Nothing if the item is none that item_of() makes.
std::optional<PathChunk> read_path_chunk(const replication::Item& item);

inline constexpr double kPathReach_m = 1e7;

}  // namespace warren
