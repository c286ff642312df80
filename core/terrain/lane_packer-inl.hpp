// SPDX-License-Identifier: Apache-2.0
// Included once per Highway target, hence no #pragma once.
#if defined(WARREN_LANE_PACKER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef WARREN_LANE_PACKER_INL
#undef WARREN_LANE_PACKER_INL
#else
#define WARREN_LANE_PACKER_INL
#endif

#include <hwy/highway.h>

#include "core/terrain/lane_tables.hpp"

HWY_BEFORE_NAMESPACE();
namespace warren::HWY_NAMESPACE {

// Moves the lanes of a mask to the front, for several vectors by one look at the mask.
// Highway 1.0's own Compress keeps its tables in local constants, which g++ 12 copies to the stack
// at every use: six times slower where there is no instruction for it.
class LanePacker {
  using D = hwy::HWY_NAMESPACE::ScalableTag<float>;
  using Vector = hwy::HWY_NAMESPACE::Vec<D>;
  using Mask = hwy::HWY_NAMESPACE::Mask<D>;

 public:
#if HWY_MAX_BYTES == 32
  HWY_INLINE explicit LanePacker(Mask mask)
      : indices_(hwy::HWY_NAMESPACE::IndicesFromVec(
            D(), hwy::HWY_NAMESPACE::PromoteTo(
                     Numbers(),
                     hwy::HWY_NAMESPACE::LoadU(hwy::HWY_NAMESPACE::Rebind<std::uint8_t, D>(),
                                               kLaneNumbers.of_mask[bits_of(mask)].data())))) {}
  HWY_INLINE Vector operator()(Vector v) const {
    return hwy::HWY_NAMESPACE::TableLookupLanes(v, indices_);
  }

 private:
  using Numbers = hwy::HWY_NAMESPACE::RebindToSigned<D>;
  decltype(hwy::HWY_NAMESPACE::IndicesFromVec(D(), hwy::HWY_NAMESPACE::Zero(Numbers()))) indices_;
#elif HWY_MAX_BYTES == 16 && HWY_TARGET != HWY_SCALAR
  HWY_INLINE explicit LanePacker(Mask mask)
      : bytes_(hwy::HWY_NAMESPACE::Load(Bytes(), kLaneBytes.of_mask[bits_of(mask)].data())) {}
  HWY_INLINE Vector operator()(Vector v) const {
    return hwy::HWY_NAMESPACE::BitCast(
        D(), hwy::HWY_NAMESPACE::TableLookupBytes(hwy::HWY_NAMESPACE::BitCast(Bytes(), v), bytes_));
  }

 private:
  using Bytes = hwy::HWY_NAMESPACE::Repartition<std::uint8_t, D>;
  hwy::HWY_NAMESPACE::Vec<Bytes> bytes_;
#else
  HWY_INLINE explicit LanePacker(Mask mask) : mask_(mask) {}
  HWY_INLINE Vector operator()(Vector v) const { return hwy::HWY_NAMESPACE::Compress(v, mask_); }

 private:
  Mask mask_;
#endif

  static HWY_INLINE std::size_t bits_of(Mask mask) {
    std::uint8_t bits[8] = {};
    hwy::HWY_NAMESPACE::StoreMaskBits(D(), mask, bits);
    return bits[0];
  }
};

}  // namespace warren::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
