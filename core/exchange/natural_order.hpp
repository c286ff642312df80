// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace warren {

// Digits count as numbers, of any length: "full2" comes before "full10".
bool natural_less(std::string_view a, std::string_view b);

// The last run of digits in a name, as a number; nothing without one, or above 18 digits.
std::optional<std::uint64_t> last_number_in(std::string_view name);

}  // namespace warren
