// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace warren {

// Cuts a text into lines, without their ends (LF or CRLF), counting from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  std::optional<std::string_view> next();
  // Number of the line that next() returned last.
  std::size_t line() const { return line_; }
  // Where the next line begins.
  std::size_t offset() const { return offset_; }

 private:
  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
};

// Takes the next field off the front of a line; empty when there is none. Fields are separated by
// any run of spaces, tabs, commas and semicolons.
std::string_view take_field(std::string_view& rest);

// Whole field as a number, "nan" and "inf" included; nothing for anything else.
std::optional<double> to_number(std::string_view field);
// Whole field as a count.
std::optional<std::size_t> to_count(std::string_view field);

// A field as it may stand in an error message: cut short, and no control characters.
std::string in_quotes(std::string_view field);

}  // namespace warren
