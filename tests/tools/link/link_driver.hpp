// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/link/link_model.hpp"

namespace warren {

inline MeshTime at_us(std::int64_t us) { return MeshTime(Duration(us)); }

inline LinkPacket packet_of(std::size_t link_bytes, StationIndex from = 0, StationIndex to = 1) {
  return {from, to, link_bytes, {}};
}

// All that arrives until `end`.
inline std::vector<LinkDelivery> arrivals_until(LinkModel& model, MeshTime end) {
  std::vector<LinkDelivery> all;
  while (auto delivery = model.poll(end)) all.push_back(std::move(*delivery));
  return all;
}

// Sends so many packets, one each `gap`, and returns all that arrives within a minute after.
inline std::vector<LinkDelivery> send_evenly(LinkModel& model, std::size_t packets, Duration gap,
                                             std::size_t bytes = 1000) {
  std::vector<LinkDelivery> all;
  MeshTime now{};
  for (std::size_t i = 0; i < packets; ++i, now += gap) {
    auto packet = packet_of(bytes);
    packet.bytes = {static_cast<std::uint8_t>(i >> 16), static_cast<std::uint8_t>(i >> 8),
                    static_cast<std::uint8_t>(i)};
    model.send(now, std::move(packet));
    for (auto& delivery : arrivals_until(model, now)) all.push_back(std::move(delivery));
  }
  for (auto& delivery : arrivals_until(model, now + std::chrono::minutes(1))) {
    all.push_back(std::move(delivery));
  }
  return all;
}

inline std::size_t number_of(const LinkDelivery& delivery) {
  return (std::size_t{delivery.bytes[0]} << 16) + (std::size_t{delivery.bytes[1]} << 8) +
         delivery.bytes[2];
}

}  // namespace warren
