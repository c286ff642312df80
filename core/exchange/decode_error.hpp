// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <tl/expected.hpp>

namespace warren {

// Why the content of a file could not be read; line 0 when no line is to blame.
struct DecodeError {
  std::size_t line = 0;
  std::string text;

  // "file:line: text", or "file: text".
  std::string located(const std::string& file) const {
    return file + ":" + (line == 0 ? std::string() : std::to_string(line) + ":") + " " + text;
  }
};

template <typename T>
using Decoded = tl::expected<T, DecodeError>;

inline tl::unexpected<DecodeError> decode_error(std::size_t line, std::string text) {
  return tl::make_unexpected(DecodeError{line, std::move(text)});
}

}  // namespace warren
