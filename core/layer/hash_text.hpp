// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/layer/digest.hpp"

namespace warren {

// Two hexadecimal digits, lower case, for each byte.
inline std::string hex_of(const Hash& hash) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * hash.size());
  for (const std::uint8_t byte : hash) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

}  // namespace warren
