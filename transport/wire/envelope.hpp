// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/mesh_id.hpp"
#include "transport/wire/key_schedule.hpp"

namespace warren::mesh {

enum class PacketType : std::uint8_t { kBeacon, kPair, kGroup };

// The clear part of every packet. Numbers are below 2^48, rise by one per packet and key, and are
// never used twice.
struct PacketHeader {
  PacketType type = PacketType::kBeacon;
  BootId sender;
  std::uint64_t number = 0;
  friend bool operator==(const PacketHeader&, const PacketHeader&) = default;
};

inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kEnvelopeBytes = kHeaderBytes + kTagBytes;
inline constexpr std::uint64_t kPacketNumberEnd = std::uint64_t{1} << 48;

// Nothing if the bytes cannot be a packet of ours or are of another format version.
std::optional<PacketHeader> read_packet_header(std::span<const std::uint8_t> packet);

// ChaCha20-Poly1305 (IETF) of the libsodium library over the header and the content.
std::vector<std::uint8_t> seal(const Key& key, const PacketHeader& header,
                               std::span<const std::uint8_t> content);
// The content; nothing if the packet was not sealed so.
std::optional<std::vector<std::uint8_t>> open(const Key& key, std::span<const std::uint8_t> packet);

}  // namespace warren::mesh
