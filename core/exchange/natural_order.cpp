// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/natural_order.hpp"

#include <algorithm>

namespace warren {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kMaxDigits = 18;  // fit 64 bits

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Takes a run of digits off the front, without its leading zeros.
std::string_view take_digits(std::string_view& rest) {
  std::string_view run = rest.substr(0, rest.find_first_not_of(kDigits));
  rest.remove_prefix(run.size());
  run.remove_prefix(std::min(run.find_first_not_of('0'), run.size()));
  return run;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view digits_a = take_digits(a);
      const std::string_view digits_b = take_digits(b);
      if (digits_a.size() != digits_b.size()) return digits_a.size() < digits_b.size();
      if (digits_a != digits_b) return digits_a < digits_b;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // differ in leading zeros at most
}

std::optional<std::uint64_t> last_number_in(std::string_view name) {
  const std::size_t last = name.find_last_of(kDigits);
  if (last == std::string_view::npos) return std::nullopt;
  const std::size_t before = name.find_last_not_of(kDigits, last);
  std::string_view run = name.substr(before + 1, last - before);  // npos + 1 is 0
  run = take_digits(run);
  if (run.size() > kMaxDigits) return std::nullopt;
  std::uint64_t number = 0;
  for (const char c : run) number = number * 10 + static_cast<std::uint64_t>(c - '0');
  return number;
}

}  // namespace warren
