// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/beacon.hpp"

#include <cassert>

#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::mesh {
namespace {

constexpr std::size_t kHeardBytes = 5;

}  // namespace

std::vector<std::uint8_t> encode(const Beacon& beacon) {
  assert(beacon.heard.size() <= Beacon::kHeardMax);
  std::vector<std::uint8_t> content;
  PacketWriter writer(content);
  writer.number(beacon.member.number);
  writer.number(beacon.uptime_s);
  writer.number(beacon.period_ms);
  for (const Beacon::Heard& heard : beacon.heard) {
    writer.fixed(heard.boot, 4);
    writer.byte(heard.loss_256th);
  }
  return content;
}

std::optional<Beacon> read_beacon(std::span<const std::uint8_t> content) {
  PacketReader reader(content);
  const auto member = reader.number(kMaxOf<std::uint32_t>);
  const auto uptime_s = reader.number(kMaxOf<std::uint32_t>);
  const auto period_ms = reader.number(kMaxOf<std::uint16_t>);
  if (!member || !uptime_s || !period_ms) return std::nullopt;
  if (reader.left() % kHeardBytes != 0 || reader.left() > Beacon::kHeardMax * kHeardBytes) {
    return std::nullopt;
  }
  Beacon beacon{{static_cast<std::uint32_t>(*member)},
                static_cast<std::uint32_t>(*uptime_s),
                static_cast<std::uint16_t>(*period_ms),
                {}};
  while (!reader.at_end()) {
    const auto boot = static_cast<std::uint32_t>(*reader.fixed(4));
    beacon.heard.push_back({boot, static_cast<std::uint8_t>(*reader.fixed(1))});
  }
  return beacon;
}

}  // namespace warren::mesh
