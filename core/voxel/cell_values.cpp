// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/cell_values.hpp"

#include "core/voxel/bits.hpp"

namespace warren {
namespace {

constexpr std::uint32_t index_of(CellValues::Ref ref) { return (ref >> 2) - 1; }

}  // namespace

void CellValues::unpack(Ref ref, std::uint64_t stored, std::array<std::int16_t, 64>& values) const {
  if (stored == 0) return;
  const std::int16_t* next = data(ref);
  for_each_bit(stored, [&](std::uint32_t bit) { values[bit] = *next++; });
}

CellValues::Ref CellValues::repack(Ref ref, std::uint64_t stored,
                                   const std::array<std::int16_t, 64>& values) {
  if (stored == 0) {
    release(ref);
    return 0;
  }
  if (ref == 0 || (ref & 3) != size_class(stored)) {
    release(ref);
    ref = allocate(size_class(stored));
  }
  std::int16_t* next = data(ref);
  for_each_bit(stored, [&](std::uint32_t bit) { *next++ = values[bit]; });
  return ref;
}

std::int16_t CellValues::value(Ref ref, std::uint64_t stored, std::uint32_t bit) const {
  const std::uint64_t before = stored & ((std::uint64_t{1} << bit) - 1);
  return data(ref)[std::popcount(before)];
}

std::size_t CellValues::memory_bytes() const {
  return eights_.memory_bytes() + sixteens_.memory_bytes() + thirty_twos_.memory_bytes() +
         sixty_fours_.memory_bytes();
}

CellValues::Ref CellValues::allocate(std::uint32_t size_class) {
  const std::uint32_t index = size_class == 0   ? eights_.allocate()
                              : size_class == 1 ? sixteens_.allocate()
                              : size_class == 2 ? thirty_twos_.allocate()
                                                : sixty_fours_.allocate();
  return (index + 1) << 2 | size_class;
}

void CellValues::release(Ref ref) {
  if (ref == 0) return;
  switch (ref & 3) {
    case 0:
      return eights_.release(index_of(ref));
    case 1:
      return sixteens_.release(index_of(ref));
    case 2:
      return thirty_twos_.release(index_of(ref));
    default:
      return sixty_fours_.release(index_of(ref));
  }
}

std::int16_t* CellValues::data(Ref ref) {
  switch (ref & 3) {
    case 0:
      return eights_[index_of(ref)].data();
    case 1:
      return sixteens_[index_of(ref)].data();
    case 2:
      return thirty_twos_[index_of(ref)].data();
    default:
      return sixty_fours_[index_of(ref)].data();
  }
}

}  // namespace warren
