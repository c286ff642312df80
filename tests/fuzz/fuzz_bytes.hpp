// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace warren::fuzz {

// The input as a list of choices. After its end there are only zeros.
class FuzzBytes {
 public:
  explicit FuzzBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool done() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (done()) return 0;
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  std::uint64_t number(std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{byte()} << (8 * i);
    return value;
  }
  // Small ones with one byte each, all up to `most` possible.
  std::uint64_t number_to(std::uint64_t most) {
    const std::uint64_t value = byte();
    if (value < 0xF8) return std::min(value, most);
    return number(value - 0xF7) % (most == UINT64_MAX ? most : most + 1);
  }
  bool flag() { return (byte() & 1U) != 0; }
  std::span<const std::uint8_t> take(std::size_t bytes) {
    const auto taken = bytes_.first(std::min(bytes, bytes_.size()));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace warren::fuzz
