// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace warren {

// The payload of a transport benchmark: every byte follows from its place, so that the receiver can
// check it without having it.
inline std::uint8_t payload_byte(std::size_t offset) {
  // An odd multiplier: neighbouring kilobytes differ.
  return static_cast<std::uint8_t>((offset * 0x9E3779B97F4A7C15ULL) >> 56);
}

inline void fill_payload(std::span<std::uint8_t> bytes, std::size_t offset) {
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = payload_byte(offset + i);
}

inline bool is_payload(std::span<const std::uint8_t> bytes, std::size_t offset) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != payload_byte(offset + i)) return false;
  }
  return true;
}

// A part of the payload as a message: its place, then its bytes. For transports that carry messages
// in any order.
inline constexpr std::size_t kPartHeaderBytes = 4;

inline std::vector<std::uint8_t> make_payload_part(std::size_t offset, std::size_t bytes) {
  std::vector<std::uint8_t> message(kPartHeaderBytes + bytes);
  for (std::size_t i = 0; i < kPartHeaderBytes; ++i) {
    message[i] = static_cast<std::uint8_t>(offset >> (8 * i));
  }
  fill_payload(std::span(message).subspan(kPartHeaderBytes), offset);
  return message;
}

class PayloadReceived {
 public:
  explicit PayloadReceived(std::size_t total_bytes) : had_(total_bytes, false) {}

  // How many new bytes this message brings: 0 if they are known, wrong or none of ours.
  std::size_t take(std::span<const std::uint8_t> message) {
    if (message.size() <= kPartHeaderBytes) return 0;
    std::size_t offset = 0;
    for (std::size_t i = 0; i < kPartHeaderBytes; ++i) offset |= std::size_t{message[i]} << (8 * i);
    const auto bytes = message.subspan(kPartHeaderBytes);
    if (offset + bytes.size() > had_.size() || !is_payload(bytes, offset)) return 0;
    std::size_t fresh = 0;
    for (std::size_t i = offset; i < offset + bytes.size(); ++i) {
      fresh += had_[i] ? 0 : 1;
      had_[i] = true;
    }
    return fresh;
  }

 private:
  std::vector<bool> had_;
};

}  // namespace warren
