// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace warren::mesh {

// Which packet numbers of one key have come: each is taken once, and none that is kWidth or more
// older than the latest.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kWidth = 2048;

  bool is_new(std::uint64_t number) const;
  // Precondition: is_new(number), and its packet was authentic.
  void mark(std::uint64_t number);

 private:
  std::array<std::uint64_t, kWidth / 64> seen_{};
  std::uint64_t end_ = 0;  // one more than the latest
};

}  // namespace warren::mesh
