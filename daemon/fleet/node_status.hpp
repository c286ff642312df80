// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/layer/claim.hpp"

namespace warren {

enum class NodeRole : std::uint8_t { kRobot, kBase };

// What a node says of itself: to neighbours as telemetry, to the whole fleet as an item of its log.
//   kind, version  1 byte   0x31
//   role           1        0 robot, 1 base
//   name           1 + n    at most 32 bytes, a-z 0-9 _ -
//   time           8        microseconds since 1970, by its own clock
//   flags          1        1: a layer follows; 2: a position follows
//   layer          16       origin, number, incarnation
//   revision       LEB128   published by then
//   digest         8        first bytes of the root at that revision
//   known          LEB128   voxels known by then
//   position       12       float32 x y z, fleet frame
struct NodeStatus {
  static constexpr std::uint8_t kKind = 0x31;
  static constexpr std::size_t kNameBytesMax = 32;
  struct Layer {
    LayerId id;
    Revision revision;
    std::uint64_t digest = 0;
    std::uint64_t known_voxels = 0;
    friend bool operator==(const Layer&, const Layer&) = default;
  };

  std::string name;
  NodeRole role = NodeRole::kRobot;
  std::int64_t time_us = 0;
  std::optional<Layer> layer;  // the one that it writes now
  std::optional<Eigen::Vector3f> position_fleet;
  friend bool operator==(const NodeStatus&, const NodeStatus&) = default;
};

std::vector<std::uint8_t> encode(const NodeStatus& status);
// Nothing if the bytes are none that encode() makes, or of another version.
std::optional<NodeStatus> read_node_status(std::span<const std::uint8_t> bytes);

}  // namespace warren
