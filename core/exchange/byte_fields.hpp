// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace warren {

// Numbers as bytes, little endian.
class ByteWriter {
 public:
  template <std::unsigned_integral Unsigned>
  void add(Unsigned number) {
    for (std::size_t i = 0; i < sizeof number; ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(number >> 8 * i));
    }
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  std::span<const std::uint8_t> bytes() const { return bytes_; }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Past the end it reads zeros, and is no longer complete().
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  template <std::unsigned_integral Unsigned>
  Unsigned number() {
    std::uint64_t read = 0;
    const std::span<const std::uint8_t> field = bytes(sizeof(Unsigned));
    for (std::size_t i = 0; i < field.size(); ++i) read |= std::uint64_t{field[i]} << 8 * i;
    return static_cast<Unsigned>(read);
  }
  double real() { return std::bit_cast<double>(number<std::uint64_t>()); }
  // None if there are not so many.
  std::span<const std::uint8_t> bytes(std::size_t count) {
    if (count > left_.size()) {
      complete_ = false;
      left_ = {};
      return {};
    }
    const auto field = left_.first(count);
    left_ = left_.subspan(count);
    return field;
  }

  bool complete() const { return complete_; }
  std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::uint8_t> left_;
  bool complete_ = true;
};

}  // namespace warren
