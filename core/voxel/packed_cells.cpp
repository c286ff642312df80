// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/packed_cells.hpp"

#include "core/voxel/bits.hpp"
#include "core/voxel/voxel_cost.hpp"

namespace warren {
namespace {

constexpr std::uint32_t index_of(std::uint32_t ref) { return (ref >> 2) - 1; }

}  // namespace

template <typename Value>
void PackedCells<Value>::unpack(Ref ref, std::uint64_t stored,
                                std::array<Value, 64>& values) const {
  if (stored == 0) return;
  const Value* next = data(ref);
  for_each_bit(stored, [&](std::uint32_t bit) { values[bit] = *next++; });
}

template <typename Value>
typename PackedCells<Value>::Ref PackedCells<Value>::repack(Ref ref, std::uint64_t stored,
                                                            const std::array<Value, 64>& values) {
  if (stored == 0) {
    release(ref);
    return 0;
  }
  if (ref == 0 || (ref & 3) != size_class(stored)) {
    release(ref);
    ref = allocate(size_class(stored));
  }
  Value* next = data(ref);
  for_each_bit(stored, [&](std::uint32_t bit) { *next++ = values[bit]; });
  return ref;
}

template <typename Value>
std::size_t PackedCells<Value>::memory_bytes() const {
  return eights_.memory_bytes() + sixteens_.memory_bytes() + thirty_twos_.memory_bytes() +
         sixty_fours_.memory_bytes();
}

template <typename Value>
typename PackedCells<Value>::Ref PackedCells<Value>::allocate(std::uint32_t size_class) {
  const std::uint32_t index = size_class == 0   ? eights_.allocate()
                              : size_class == 1 ? sixteens_.allocate()
                              : size_class == 2 ? thirty_twos_.allocate()
                                                : sixty_fours_.allocate();
  return (index + 1) << 2 | size_class;
}

template <typename Value>
void PackedCells<Value>::release(Ref ref) {
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

template <typename Value>
Value* PackedCells<Value>::data(Ref ref) {
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

template class PackedCells<std::int16_t>;
template class PackedCells<FusedCost>;

}  // namespace warren
