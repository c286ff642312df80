// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/layer/replica.hpp"
#include "tests/core/layer/random_codes.hpp"

namespace warren::test {

// A winding drift 4 m wide and 3 m high of voxels of 0.1 m: rough walls with costs, free within,
// grown from one end to the other by a publication per block of length.
inline VoxelCode mine_code(const VoxelKey& key, std::uint32_t noise) {
  const double middle = 60.0 * std::sin(key.x / 200.0);
  const double across = std::abs(key.y - middle) / 20.0;
  const double up = std::abs(key.z - 4.0) / 15.0;
  const double rough = 0.03 * std::sin(key.x * 0.31) * std::sin(key.y * 0.23 + key.z * 0.41);
  const double out = std::max(across, up) + rough + noise % 4 / 400.0;
  if (out > 1.05) return {};
  if (out < 0.98) return noise % 512 == 0 ? VoxelCode{} : VoxelCode::free();
  if (noise % 32 == 0) return {};
  const bool is_floor = key.z < 0 && across < 0.98;
  return VoxelCode::occupied(is_floor ? static_cast<CostCode>(noise % 8 == 1 ? 2 : 1) : kNoCostData,
                             false);
}

inline Replica mine_layer(const LayerId& id, std::int32_t length_blocks) {
  Random random(5);
  Replica layer(id, kDefaultResolution);
  for (std::int32_t x = 0; x < length_blocks; ++x) {
    std::vector<CodedBlock> slice;
    for (std::int32_t y = -12; y < 12; ++y) {
      for (std::int32_t z = -3; z < 4; ++z) {
        const BlockKey block{x, y, z};
        const BlockOrdinal ordinal = ordinal_of(block);
        BlockCodes codes;
        for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
          codes.set(place, mine_code(key_of_morton(ordinal << 9 | place),
                                     static_cast<std::uint32_t>(random() >> 40)));
        }
        if (any(codes.known)) slice.push_back({ordinal, CodeBlock(codes)});
      }
    }
    layer.publish(slice);
  }
  return layer;
}

inline std::uint64_t known_voxels(const Replica& layer) {
  std::uint64_t known = 0;
  layer.for_each_changed({}, {}, [&](BlockOrdinal, const LayerBlock& block) {
    block.codes.for_each_known([&](std::uint32_t, VoxelCode) { ++known; });
    return true;
  });
  return known;
}

}  // namespace warren::test
