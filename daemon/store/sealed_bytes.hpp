// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace warren {

// CRC-32C (Castagnoli, RFC 3720 appendix B.4) of bytes, continued from that of those before.
std::uint32_t crc32c(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

// SQLite checks the shape of its pages, not what is in them: every row ends with a checksum of its
// key and its bytes.
inline constexpr std::size_t kSealBytes = 4;
void seal(std::int64_t key, std::vector<std::uint8_t>& bytes);
// The bytes without their seal; nothing if key or bytes are not those that were sealed.
std::optional<std::span<const std::uint8_t>> unsealed(std::int64_t key,
                                                      std::span<const std::uint8_t> bytes);

}  // namespace warren
