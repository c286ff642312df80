// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/text_fields.hpp"

#include <charconv>

namespace warren {
namespace {

constexpr std::string_view kSeparators = " \t,;\r\v\f";
constexpr std::size_t kQuotedLength = 40;

}  // namespace

std::optional<std::string_view> LineReader::next() {
  if (offset_ >= text_.size()) return std::nullopt;
  const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
  std::string_view line = text_.substr(offset_, end - offset_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  offset_ = std::min(end + 1, text_.size());
  ++line_;
  return line;
}

std::string_view take_field(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kSeparators), rest.size()));
  const std::string_view field = rest.substr(0, rest.find_first_of(kSeparators));
  rest.remove_prefix(field.size());
  return field;
}

std::optional<double> to_number(std::string_view field) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (end != field.data() + field.size() || error != std::errc{}) return std::nullopt;
  return number;
}

std::optional<std::size_t> to_count(std::string_view field) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (end != field.data() + field.size() || error != std::errc{}) return std::nullopt;
  return number;
}

std::string in_quotes(std::string_view field) {
  std::string text = "'";
  for (const char c : field.substr(0, kQuotedLength)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (field.size() > kQuotedLength ? "...'" : "'");
}

}  // namespace warren
