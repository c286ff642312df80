// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>

namespace warren::mesh {

// Which urgent messages of one boot have come. Numbers wrap around; one more than kWidth before
// the latest counts as come.
class UrgentWindow {
 public:
  static constexpr std::uint32_t kWidth = 1024;

  // Whether it is new; then it has come.
  bool take(std::uint32_t number);

 private:
  std::bitset<kWidth> come_;  // by number modulo kWidth
  std::optional<std::uint32_t> latest_;
};

}  // namespace warren::mesh
