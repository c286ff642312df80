// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace warren {

inline constexpr std::size_t kMessageKeyBytesMax = 24;

// What may stand beside a message so that only the latest of it counts. Empty: nothing does. It
// comes to operators' terminals.
inline bool is_message_key(std::string_view key) {
  return key.size() <= kMessageKeyBytesMax &&
         key.find_first_not_of(
             "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./") ==
             std::string_view::npos;
}

}  // namespace warren
