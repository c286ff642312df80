// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace warren::mesh {

// Memory for the unfinished parcels of one direction, of all peers together.
class ParcelBudget {
 public:
  // What is charged for a parcel: its bytes and what it takes beside them.
  static constexpr std::size_t charge(std::size_t bytes) { return bytes + 256; }

  explicit ParcelBudget(std::size_t limit_bytes) : limit_(limit_bytes) {}

  bool take(std::size_t bytes) {
    if (bytes > limit_ || used_ > limit_ - bytes) {
      ++refused_;
      return false;
    }
    used_ += bytes;
    return true;
  }
  // What was restored counts even beyond the limit: it was promised.
  void take_anyway(std::size_t bytes) { used_ += bytes; }
  void give_back(std::size_t bytes) {
    assert(bytes <= used_);
    used_ -= bytes;
  }
  std::size_t used() const { return used_; }
  // How often there was no room.
  std::uint64_t refused() const { return refused_; }

 private:
  std::size_t limit_;
  std::size_t used_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace warren::mesh
