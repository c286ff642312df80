// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace warren {

// Numbers of a few bits one behind the other, lowest bit first.
class BitWriter {
 public:
  void put(std::uint32_t value, int bits) {
    for (int i = 0; i < bits; ++i, ++written_) {
      if (written_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() |= static_cast<std::uint8_t>((value >> i & 1) << (written_ % 8));
    }
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t written_ = 0;
};

// Past the end it reads zeros.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t get(int bits) {
    std::uint32_t value = 0;
    for (int i = 0; i < bits; ++i, ++read_) {
      if (read_ / 8 >= bytes_.size()) continue;
      value |= static_cast<std::uint32_t>(bytes_[read_ / 8] >> (read_ % 8) & 1) << i;
    }
    return value;
  }
  std::size_t bytes_read() const { return (read_ + 7) / 8; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t read_ = 0;
};

}  // namespace warren
