// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/exchange/byte_fields.hpp"

namespace warren {

// Numbers that repeat: the values that occur, ascending, then for each number which of them, in as
// few bits as tell them apart. How many numbers there are the reader knows already. Unless that is
// none: one byte with how many values occur, 0 for too many (then the numbers follow as they are).
inline constexpr std::size_t kValuesMax = 255;

template <std::unsigned_integral Value>
std::vector<Value> values_in(std::span<const Value> numbers) {
  std::vector<Value> values(numbers.begin(), numbers.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// Bits, lowest first, in whole bytes.
class BitWriter {
 public:
  explicit BitWriter(ByteWriter& writer) : writer_(writer) {}
  void add(std::uint32_t number, int bits) {
    held_ |= std::uint64_t{number} << held_bits_;
    held_bits_ += bits;
    for (; held_bits_ >= 8; held_bits_ -= 8, held_ >>= 8) {
      writer_.add(static_cast<std::uint8_t>(held_));
    }
  }
  void finish() {
    if (held_bits_ > 0) writer_.add(static_cast<std::uint8_t>(held_));
  }

 private:
  ByteWriter& writer_;
  std::uint64_t held_ = 0;
  int held_bits_ = 0;
};

template <std::unsigned_integral Value>
void write_values(std::span<const Value> numbers, ByteWriter& writer) {
  if (numbers.empty()) return;
  const std::vector<Value> values = values_in(numbers);
  const bool listed = values.size() <= kValuesMax;
  writer.add(static_cast<std::uint8_t>(listed ? values.size() : 0));
  for (const Value value : listed ? std::span<const Value>(values) : numbers) writer.add(value);
  if (!listed) return;
  BitWriter bits(writer);
  for (const Value number : numbers) {
    const auto rank = std::lower_bound(values.begin(), values.end(), number) - values.begin();
    bits.add(static_cast<std::uint32_t>(rank), static_cast<int>(std::bit_width(values.size() - 1)));
  }
  bits.finish();
}

// As many numbers, each named by its rank among the values; nothing if a rank is none, if a value
// is named by no number, or if bits are left over that are not 0.
template <std::unsigned_integral Value>
std::optional<std::vector<Value>> read_ranked(std::span<const Value> values, std::size_t count,
                                              ByteReader& reader) {
  const int width = static_cast<int>(std::bit_width(values.size() - 1));
  std::vector<Value> numbers;
  numbers.reserve(count);
  std::array<bool, kValuesMax> named{};
  std::uint64_t held = 0;
  for (int held_bits = 0; numbers.size() < count; held_bits -= width, held >>= width) {
    for (; held_bits < width; held_bits += 8) {
      held |= std::uint64_t{reader.number<std::uint8_t>()} << held_bits;
    }
    const std::uint64_t rank = held & ((std::uint64_t{1} << width) - 1);
    if (rank >= values.size()) return std::nullopt;
    named[rank] = true;
    numbers.push_back(values[rank]);
  }
  const auto all_named = std::all_of(named.begin(), named.begin() + std::ssize(values),
                                     [](bool is_named) { return is_named; });
  if (held != 0 || !all_named) return std::nullopt;
  return numbers;
}

// Nothing if the bytes are none that write_values() makes of so many numbers.
template <std::unsigned_integral Value>
std::optional<std::vector<Value>> read_values(std::size_t count, ByteReader& reader) {
  if (count == 0) return std::vector<Value>();
  const std::size_t listed = reader.number<std::uint8_t>();
  std::vector<Value> values(listed != 0 ? listed : count);
  for (Value& value : values) value = reader.number<Value>();
  if (listed == 0) {
    const bool too_many = values_in(std::span<const Value>(values)).size() > kValuesMax;
    return too_many && reader.complete() ? std::optional(std::move(values)) : std::nullopt;
  }
  const bool rising =
      std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  if (!rising) return std::nullopt;
  auto numbers = read_ranked(std::span<const Value>(values), count, reader);
  return reader.complete() ? numbers : std::nullopt;
}

}  // namespace warren
