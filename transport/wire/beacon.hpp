// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/mesh_id.hpp"

namespace warren::mesh {

// "I am here, and these I hear." Sealed with the sender's group key.
struct Beacon {
  static constexpr std::size_t kHeardMax = 8;

  struct Heard {
    std::uint32_t boot = 0;       // the low half of its boot id
    std::uint8_t loss_256th = 0;  // of its beacons and packets, as the sender saw it
    friend bool operator==(const Heard&, const Heard&) = default;
  };

  MemberId member;
  std::uint32_t uptime_s = 0;   // of this boot
  std::uint16_t period_ms = 0;  // until the next one, at most
  std::vector<Heard> heard;     // some of them, in turn
  friend bool operator==(const Beacon&, const Beacon&) = default;
};

std::vector<std::uint8_t> encode(const Beacon& beacon);
std::optional<Beacon> read_beacon(std::span<const std::uint8_t> content);

}  // namespace warren::mesh
