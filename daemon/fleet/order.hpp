// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "core/layer/layer_pose.hpp"
#include "daemon/replication/item.hpp"

namespace warren {

// What the operator at a base wants of the whole fleet, as a command item of the base's log. The
// item's bytes:
//   kind, version  1 byte  0x33
//   verb           1       0 retract, 1 restore, 2 align
//   revision       4       above all orders on this node that the writer knew
//   writer         4       the base
//   node           4       whose layers are meant
//   flag           1       1: one layer is meant, and follows; 0: all, later ones too
//   layer          12      number, incarnation
//   correction     56      align alone: 7 float64, x y z qx qy qz qw
// Its name: 'o', 1 if it aligns, else 0, node, and the layer if there is one: so in a log only the
// latest order on a subject counts. Among several bases the highest revision does, and among equal
// ones the higher writer.
struct Order {
  static constexpr std::uint8_t kKind = 0x33;
  enum class Verb : std::uint8_t { kRetract, kRestore, kAlign };

  Verb verb = Verb::kRetract;
  std::uint32_t revision = 0;
  std::uint32_t writer = 0;
  std::uint32_t node = 0;
  std::optional<LayerId> layer;  // of that node; always there if it aligns
  Pose correction;               // a motion in the fleet frame, as LayerPose has it
};

replication::Item item_of(const Order& order);
// Nothing if the item is none that item_of() makes.
std::optional<Order> read_order(const replication::Item& item);

}  // namespace warren
