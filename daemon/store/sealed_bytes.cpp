// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/sealed_bytes.hpp"

#include <array>

namespace warren {
namespace {

// Tables to take eight bytes at a time: the n-th continues a byte by n zeros.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables made_tables() {
  constexpr std::uint32_t kReversedPolynomial = 0x82F63B78U;
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? kReversedPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t zeros = 1; zeros < tables.size(); ++zeros) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[zeros - 1][byte];
      tables[zeros][byte] = crc >> 8 ^ tables[0][crc & 0xFF];
    }
  }
  return tables;
}

constexpr Tables kCrcTables = made_tables();

std::uint32_t crc_of(std::int64_t key, std::span<const std::uint8_t> bytes) {
  std::array<std::uint8_t, 8> key_bytes{};
  for (std::size_t i = 0; i < key_bytes.size(); ++i) {
    key_bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(key) >> 8 * i);
  }
  return crc32c(bytes, crc32c(key_bytes));
}

}  // namespace

std::uint32_t crc32c(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      next ^= kCrcTables[7 - i][(crc >> 8 * i & 0xFF) ^ bytes[i]] ^ kCrcTables[3 - i][bytes[i + 4]];
    }
    crc = next;
  }
  for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ kCrcTables[0][(crc ^ byte) & 0xFF];
  return ~crc;
}

void seal(std::int64_t key, std::vector<std::uint8_t>& bytes) {
  const std::uint32_t crc = crc_of(key, bytes);
  for (std::size_t i = 0; i < kSealBytes; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8 * i));
  }
}

std::optional<std::span<const std::uint8_t>> unsealed(std::int64_t key,
                                                      std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kSealBytes) return std::nullopt;
  const auto content = bytes.first(bytes.size() - kSealBytes);
  const auto seal = bytes.last(kSealBytes);
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < kSealBytes; ++i) crc |= std::uint32_t{seal[i]} << 8 * i;
  if (crc != crc_of(key, content)) return std::nullopt;
  return content;
}

}  // namespace warren
