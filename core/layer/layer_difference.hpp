// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/layer/replica.hpp"

namespace warren {

// Voxels by how two layers differ there.
struct LayerDifference {
  std::uint64_t only_in_a = 0;  // known there, unknown in the other
  std::uint64_t only_in_b = 0;
  std::uint64_t occupancy = 0;  // free in one, occupied in the other
  std::uint64_t cost = 0;       // occupied in both; may count as a stair too
  std::uint64_t stair = 0;

  bool any() const { return *this != LayerDifference{}; }
  friend bool operator==(const LayerDifference&, const LayerDifference&) = default;
};

// Compares key by key, wherever the layers lie; what their digests prove equal is not looked at.
// Precondition: equal resolutions.
LayerDifference difference_of(const Replica& a, const Replica& b);

}  // namespace warren
