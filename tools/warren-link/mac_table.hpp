// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "tools/link/link_model.hpp"

namespace warren {

// A learning switch's memory: which station sends from which Ethernet address.
class MacTable {
 public:
  static constexpr std::size_t kHeaderBytes = 14;
  static constexpr std::size_t kAddressesMax = 4096;

  // Where a frame from `from` goes to: one station, or all if it is for a group or for an address
  // never heard. Precondition: at least kHeaderBytes.
  StationIndex route(StationIndex from, std::span<const std::uint8_t> frame) {
    const Address to = address(frame.first<6>());
    const Address source = address(frame.subspan<6, 6>());
    if (!is_group(source) && (stations_.size() < kAddressesMax || stations_.contains(source))) {
      stations_[source] = from;
    }
    if (is_group(to)) return kEveryStation;
    const auto found = stations_.find(to);
    return found == stations_.end() ? kEveryStation : found->second;
  }

 private:
  using Address = std::array<std::uint8_t, 6>;

  static Address address(std::span<const std::uint8_t, 6> bytes) {
    Address copy;
    std::copy(bytes.begin(), bytes.end(), copy.begin());
    return copy;
  }
  static bool is_group(const Address& address) { return (address[0] & 1) != 0; }

  std::map<Address, StationIndex> stations_;
};

}  // namespace warren
