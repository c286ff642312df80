// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/voxel/chunked_pool.hpp"

namespace warren {

// Values of the voxels of 4x4x4 cells, packed: a cell keeps values only for the voxels in its
// `stored` mask, in the mask's bit order, in the smallest of four sizes that holds them.
template <typename Value>
class PackedCells {
 public:
  // 0: no values. Otherwise size class in the low two bits, index + 1 above.
  using Ref = std::uint32_t;

  // Writes the values of the mask's voxels to their places; other places keep what they had.
  void unpack(Ref ref, std::uint64_t stored, std::array<Value, 64>& values) const;
  // Replaces the cell's values by those of `stored` and returns its new reference.
  Ref repack(Ref ref, std::uint64_t stored, const std::array<Value, 64>& values);
  // Value of one voxel, whose bit must be in the mask.
  Value value(Ref ref, std::uint64_t stored, std::uint32_t bit) const {
    return data(ref)[place_of(stored, bit)];
  }
  Value& value(Ref ref, std::uint64_t stored, std::uint32_t bit) {
    return data(ref)[place_of(stored, bit)];
  }

  std::size_t memory_bytes() const;

 private:
  static constexpr int place_of(std::uint64_t stored, std::uint32_t bit) {
    return std::popcount(stored & ((std::uint64_t{1} << bit) - 1));
  }
  static constexpr std::uint32_t size_class(std::uint64_t stored) {
    const int count = std::popcount(stored);
    return count <= 8 ? 0 : count <= 16 ? 1 : count <= 32 ? 2 : 3;
  }
  Ref allocate(std::uint32_t size_class);
  void release(Ref ref);
  Value* data(Ref ref);
  const Value* data(Ref ref) const { return const_cast<PackedCells*>(this)->data(ref); }

  ChunkedPool<std::array<Value, 8>, 512> eights_;
  ChunkedPool<std::array<Value, 16>, 256> sixteens_;
  ChunkedPool<std::array<Value, 32>, 128> thirty_twos_;
  ChunkedPool<std::array<Value, 64>, 64> sixty_fours_;
};

}  // namespace warren
