// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/config/schema.hpp"

namespace warren {

// A value as the file has it.
struct RawScalar {
  std::string text;
  bool quoted = false;
  bool is_null = false;
};
struct RawValue {
  bool is_list = false;
  std::vector<RawScalar> scalars;  // one, unless it is a list
};

// What a value may be, beside its type.
struct ValueRule {
  Limits limits;
  std::span<const std::string_view> choices;
};

// Puts the value where the slot points; if it does not fit, nothing changes and the error says why.
tl::expected<void, std::string> read_value(const RawValue& raw, const Slot& slot,
                                           const ValueRule& rule);
// The value as YAML that reads back equal.
std::string print_value(const Slot& slot, const ValueRule& rule);
// What may be given, in words.
std::string describe_allowed(const Slot& slot, const ValueRule& rule);
// Shortest text that reads back as the same number.
std::string print_number(double number);

}  // namespace warren
