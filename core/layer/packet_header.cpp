// SPDX-License-Identifier: Apache-2.0
#include "core/layer/packet_header.hpp"

#include <bit>
#include <cassert>
#include <limits>
#include <optional>

namespace warren {
namespace {

constexpr int kKeyBytes = 5;

int trimmed_length(BlockOrdinal key) {
  return key == 0 ? 0 : kKeyBytes - std::countr_zero(key) / 8;
}

void write_key(std::vector<std::uint8_t>& bytes, BlockOrdinal key, int length) {
  for (int i = 0; i < length; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(key >> 8 * (kKeyBytes - 1 - i)));
  }
}

void write_leb128(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

// Takes bytes from the front; nothing when they end early or are not the shortest encoding.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t position() const { return position_; }

  std::optional<std::uint8_t> byte() {
    if (position_ == bytes_.size()) return std::nullopt;
    return bytes_[position_++];
  }

  std::optional<BlockOrdinal> key(int length) {
    BlockOrdinal key = 0;
    if (length > kKeyBytes) return std::nullopt;
    for (int i = 0; i < length; ++i) {
      const auto next = byte();
      if (!next) return std::nullopt;
      key |= BlockOrdinal{*next} << 8 * (kKeyBytes - 1 - i);
    }
    return trimmed_length(key) == length ? std::optional(key) : std::nullopt;
  }

  std::optional<std::uint32_t> leb128() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const auto next = byte();
      if (!next) return std::nullopt;
      value |= std::uint64_t{*next & 0x7FU} << shift;
      if ((*next & 0x80) != 0) continue;
      const bool shortest = *next != 0 || shift == 0;
      if (!shortest || value > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
      return static_cast<std::uint32_t>(value);
    }
    return std::nullopt;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

std::optional<Claim> read_claim(Reader& reader) {
  const auto lengths = reader.byte();
  if (!lengths) return std::nullopt;
  const auto first = reader.key(*lengths & 15);
  const auto end = reader.key(*lengths >> 4);
  const auto from = reader.leb128();
  const auto span = reader.leb128();
  if (!first || !end || !from || !span) return std::nullopt;
  if (*span >= std::numeric_limits<std::uint32_t>::max() - *from) return std::nullopt;
  const Claim claim{
      {*first, *end == 0 ? kOrdinalEnd : *end}, Revision{*from}, Revision{*from + *span + 1}};
  const bool explicit_end = *end == kOrdinalEnd;
  return claim.valid() && !explicit_end ? std::optional(claim) : std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> write_header(const Claim& claim) {
  assert(claim.valid());
  const int first_length = trimmed_length(claim.keys.first);
  const int end_length = claim.keys.end == kOrdinalEnd ? 0 : trimmed_length(claim.keys.end);
  std::vector<std::uint8_t> bytes = {kPacketVersion,
                                     static_cast<std::uint8_t>(first_length | end_length << 4)};
  write_key(bytes, claim.keys.first, first_length);
  write_key(bytes, claim.keys.end, end_length);
  write_leb128(bytes, claim.from.number);
  write_leb128(bytes, claim.to.number - claim.from.number - 1);
  return bytes;
}

std::size_t header_bytes_max(const Claim& claim) {
  const Claim open_end{{claim.keys.first, kOrdinalEnd}, claim.from, claim.to};
  return write_header(open_end).size() + kKeyBytes;
}

tl::expected<PacketHeader, PacketError> read_header(std::span<const std::uint8_t> packet) {
  Reader reader(packet);
  const auto version = reader.byte();
  if (!version) return tl::unexpected(PacketError::kMalformed);
  if (*version != kPacketVersion) return tl::unexpected(PacketError::kUnknownVersion);
  const auto claim = read_claim(reader);
  if (!claim) return tl::unexpected(PacketError::kMalformed);
  return PacketHeader{*claim, reader.position()};
}

}  // namespace warren
