// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <cstdint>

#include "core/layer/diff_contexts.hpp"

namespace warren {
namespace {

// Two hexadecimal digits per context, in rows.
constexpr const char* kTable[] = {
#include "core/layer/diff_priors_table.inc"
};

constexpr unsigned value_of(char digit) {
  return static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
}

DiffPriors read_table() {
  DiffPriors priors;
  priors.reserve(diff_context::kCount);
  for (const char* row : kTable) {
    for (; row[0] != '\0'; row += 2) {
      priors.push_back(
          prior_of(static_cast<std::uint8_t>(value_of(row[0]) << 4 | value_of(row[1]))));
    }
  }
  assert(priors.size() == diff_context::kCount);
  return priors;
}

}  // namespace

const DiffPriors& diff_priors() {
  static const DiffPriors kPriors = read_table();
  return kPriors;
}

}  // namespace warren
