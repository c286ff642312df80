// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/blocks_cursor.hpp"

#include <array>
#include <bit>

#include "daemon/control/request.hpp"

namespace warren {
namespace {

constexpr std::size_t kNumbers = 6;
constexpr std::size_t kBytesPerNumber = 8;

// FNV-1a, eight bytes at a time; then what differs in the upper bits shows in the lower ones too.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x100000001B3ULL;
  return hash ^ hash >> 29;
}

}  // namespace

std::string encode_cursor(const BlocksCursor& cursor) {
  const std::array<std::uint64_t, kNumbers> numbers{cursor.run,   cursor.scope, cursor.frame,
                                                    cursor.since, cursor.until, cursor.next};
  std::string bytes;
  for (const std::uint64_t number : numbers) {
    for (std::size_t i = 0; i < kBytesPerNumber; ++i) {
      bytes.push_back(static_cast<char>(number >> 8 * i & 0xFFU));
    }
  }
  return bytes;
}

std::optional<BlocksCursor> decode_cursor(std::string_view bytes) {
  if (bytes.size() != kNumbers * kBytesPerNumber) return std::nullopt;
  std::array<std::uint64_t, kNumbers> numbers{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    numbers[i / kBytesPerNumber] |= std::uint64_t{static_cast<std::uint8_t>(bytes[i])}
                                    << 8 * (i % kBytesPerNumber);
  }
  const BlocksCursor cursor{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
  const bool is_sane = cursor.since <= cursor.until && cursor.next <= kOrdinalEnd;
  if (!is_sane) return std::nullopt;
  return cursor;
}

std::uint64_t BlocksQuestion::scope() const {
  std::uint64_t hash = mixed(0xCBF29CE484222325ULL, static_cast<std::uint64_t>(source));
  if (!box) return hash;
  for (const Eigen::Vector3d& corner : {box->low, box->high}) {
    for (const double coordinate : corner) {
      hash = mixed(hash, std::bit_cast<std::uint64_t>(coordinate));
    }
  }
  return hash;
}

}  // namespace warren
