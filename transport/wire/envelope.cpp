// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/envelope.hpp"

#include <array>
#include <cassert>

#include <sodium/crypto_aead_chacha20poly1305.h>

#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren::mesh {
namespace {

constexpr std::uint8_t kVersion = 1;
static_assert(kTagBytes == crypto_aead_chacha20poly1305_IETF_ABYTES);

using Nonce = std::array<std::uint8_t, crypto_aead_chacha20poly1305_IETF_NPUBBYTES>;

// One key seals beacons and group packets, each with numbers of their own: the type is part of it.
Nonce nonce_of(const PacketHeader& header) {
  Nonce nonce{};
  nonce[0] = static_cast<std::uint8_t>(header.type);
  for (std::size_t i = 0; i < 6; ++i) {
    nonce[6 + i] = static_cast<std::uint8_t>(header.number >> 8 * i);
  }
  return nonce;
}

}  // namespace

std::optional<PacketHeader> read_packet_header(std::span<const std::uint8_t> packet) {
  if (packet.size() < kEnvelopeBytes) return std::nullopt;
  const auto type = static_cast<std::uint8_t>(packet[0] & 0x0F);
  if (packet[0] >> 4 != kVersion || type > static_cast<std::uint8_t>(PacketType::kGroup) ||
      packet[1] != 0) {
    return std::nullopt;
  }
  PacketReader reader(packet.subspan(2));
  const BootId sender{*reader.fixed(8)};
  return PacketHeader{static_cast<PacketType>(type), sender, *reader.fixed(6)};
}

std::vector<std::uint8_t> seal(const Key& key, const PacketHeader& header,
                               std::span<const std::uint8_t> content) {
  assert(header.number < kPacketNumberEnd);
  std::vector<std::uint8_t> packet;
  packet.reserve(kEnvelopeBytes + content.size());
  PacketWriter writer(packet);
  writer.byte(static_cast<std::uint8_t>(kVersion << 4 | static_cast<std::uint8_t>(header.type)));
  writer.byte(0);
  writer.fixed(header.sender.bits, 8);
  writer.fixed(header.number, 6);
  packet.resize(kEnvelopeBytes + content.size());
  crypto_aead_chacha20poly1305_ietf_encrypt(packet.data() + kHeaderBytes, nullptr, content.data(),
                                            content.size(), packet.data(), kHeaderBytes, nullptr,
                                            nonce_of(header).data(), key.data());
  return packet;
}

std::optional<std::vector<std::uint8_t>> open(const Key& key,
                                              std::span<const std::uint8_t> packet) {
  const auto header = read_packet_header(packet);
  if (!header) return std::nullopt;
  std::vector<std::uint8_t> content(packet.size() - kEnvelopeBytes);
  const auto sealed = packet.subspan(kHeaderBytes);
  const int failed = crypto_aead_chacha20poly1305_ietf_decrypt(
      content.data(), nullptr, nullptr, sealed.data(), sealed.size(), packet.data(), kHeaderBytes,
      nonce_of(*header).data(), key.data());
  if (failed != 0) return std::nullopt;
  return content;
}

}  // namespace warren::mesh
