// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace warren::mesh {

template <typename T>
inline constexpr std::uint64_t kMaxOf = std::numeric_limits<T>::max();

// Takes fields from the front of a packet, as PacketWriter put them. Nothing when the bytes end
// early, when a number is not in its shortest form or when it is above the caller's limit.
class PacketReader {
 public:
  explicit PacketReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool at_end() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }

  std::optional<std::uint64_t> fixed(std::size_t bytes) {
    const auto field = raw(bytes);
    if (!field) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{(*field)[i]} << 8 * i;
    return value;
  }

  std::optional<std::uint64_t> number(std::uint64_t max) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      if (at_end()) return std::nullopt;
      const std::uint8_t next = rest_.front();
      rest_ = rest_.subspan(1);
      value |= std::uint64_t{next & 0x7FU} << shift;
      if ((next & 0x80) != 0) continue;
      const bool shortest = next != 0 || shift == 0;
      return shortest && value <= max ? std::optional(value) : std::nullopt;
    }
    return std::nullopt;
  }

  std::optional<std::span<const std::uint8_t>> raw(std::size_t bytes) {
    if (bytes > left()) return std::nullopt;
    const auto field = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return field;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace warren::mesh
