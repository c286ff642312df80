// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace warren {

// Both local sockets put 4 bytes of length, little endian, before a protobuf message.
inline std::uint32_t read_length(const std::array<std::byte, 4>& bytes) {
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length |= std::to_integer<std::uint32_t>(bytes[i]) << 8 * i;
  return length;
}

// Puts the length of `message` before it.
inline std::string framed(const std::string& message) {
  const auto length = static_cast<std::uint32_t>(message.size());
  std::string frame;
  frame.reserve(message.size() + 4);
  for (unsigned i = 0; i < 4; ++i) frame.push_back(static_cast<char>(length >> 8 * i & 0xFFU));
  return frame.append(message);
}

}  // namespace warren
