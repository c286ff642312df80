// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/layer/holdings.hpp"
#include "core/layer/resolution.hpp"
#include "transport/mesh_id.hpp"

namespace warren::replication {

// How many nodes hand a layer on until it is here: 0 at its origin; kNoWay: nobody who does gets it
// from the origin now.
using Hops = std::uint8_t;
inline constexpr Hops kNoWay = 16;

// What a node tells everybody of one layer that it holds: a telemetry value, so the latest counts.
//   kind, version   1 byte    0x11
//   layer           16
//   resolution      LEB128    micrometres
//   hops            1
//   provider        LEB128    member number + 1; 0: none
//   holdings        2 to 700
//   digest          0 or 8    first bytes of the root
struct Announcement {
  static constexpr std::uint8_t kKind = 0x11;

  LayerId layer;
  Resolution resolution;
  Hops hops = kNoWay;
  std::optional<MemberId> provider;  // whom it gets the layer from
  Holdings holdings;                 // as its store has them
  // With the whole layer held at one revision, and quiet for a while.
  std::optional<std::uint64_t> digest;
  friend bool operator==(const Announcement&, const Announcement&) = default;
};

std::vector<std::uint8_t> encode(const Announcement& announcement);
// Nothing if it is malformed or of another version.
std::optional<Announcement> read_announcement(std::span<const std::uint8_t> bytes);

}  // namespace warren::replication
