// SPDX-License-Identifier: Apache-2.0
#include "daemon/printable.hpp"

#include <cstddef>

namespace warren {
namespace {

bool is_control(unsigned char byte) { return byte < 0x20 || byte == 0x7F; }

// U+0080 to U+009F.
bool is_latin1_control(unsigned char byte, unsigned char next) {
  return byte == 0xC2 && next >= 0x80 && next <= 0x9F;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    const bool is_pair = is_latin1_control(byte, next);
    shown += is_pair || is_control(byte) ? ' ' : text[i];
    if (is_pair) ++i;
  }
  return shown;
}

}  // namespace warren
