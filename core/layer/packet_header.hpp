// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "core/layer/claim.hpp"

namespace warren {

inline constexpr std::uint8_t kPacketVersion = 1;

enum class PacketError : std::uint8_t { kUnknownVersion, kMalformed };

// A packet begins with its version (one byte) and its claim:
//   lengths   1 byte   of `first` in the low, of `end` in the high four bits, 0 to 5 each
//   first     0 to 5   a 40-bit number, highest byte first, without the zero bytes at its end
//   end       0 to 5   likewise; of length 0: the end of the key space
//   from      1 to 5   LEB128
//   to        1 to 5   LEB128 of to - from - 1
// A claim has one encoding; others are malformed.
// Precondition for both: the claim is valid.
std::vector<std::uint8_t> write_header(const Claim& claim);
// As many bytes as the claim takes with any other end.
std::size_t header_bytes_max(const Claim& claim);

struct PacketHeader {
  Claim claim;
  std::size_t bytes = 0;
};
tl::expected<PacketHeader, PacketError> read_header(std::span<const std::uint8_t> packet);

}  // namespace warren
