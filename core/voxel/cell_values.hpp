// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/voxel/chunked_pool.hpp"

namespace warren {

// Log-odds of the voxels of 4x4x4 cells, packed: a cell keeps values only for the voxels in its
// `stored` mask, in the mask's bit order, in the smallest of four sizes that holds them.
class CellValues {
 public:
  // 0: no values. Otherwise size class in the low two bits, index + 1 above.
  using Ref = std::uint32_t;

  // Writes the values of the mask's voxels to their places; other places keep what they had.
  void unpack(Ref ref, std::uint64_t stored, std::array<std::int16_t, 64>& values) const;
  // Replaces the cell's values by those of `stored` and returns its new reference.
  Ref repack(Ref ref, std::uint64_t stored, const std::array<std::int16_t, 64>& values);
  // Value of one voxel, whose bit must be in the mask.
  std::int16_t value(Ref ref, std::uint64_t stored, std::uint32_t bit) const;

  std::size_t memory_bytes() const;

 private:
  static constexpr std::uint32_t size_class(std::uint64_t stored) {
    const int count = std::popcount(stored);
    return count <= 8 ? 0 : count <= 16 ? 1 : count <= 32 ? 2 : 3;
  }
  Ref allocate(std::uint32_t size_class);
  void release(Ref ref);
  std::int16_t* data(Ref ref);
  const std::int16_t* data(Ref ref) const { return const_cast<CellValues*>(this)->data(ref); }

  ChunkedPool<std::array<std::int16_t, 8>, 512> eights_;
  ChunkedPool<std::array<std::int16_t, 16>, 256> sixteens_;
  ChunkedPool<std::array<std::int16_t, 32>, 128> thirty_twos_;
  ChunkedPool<std::array<std::int16_t, 64>, 64> sixty_fours_;
};

}  // namespace warren
