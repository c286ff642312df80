// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/step_kernel.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/step_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/terrain/lane_packer-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace warren::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<float>;
inline constexpr int kHalvings = 8;

struct KeptHeights {
  std::size_t count = 0;
  float lowest = 0.0F;
  float highest = 0.0F;
};

// Heights of the candidates within the radius, and behind them infinity up to a whole vector.
KeptHeights keep_heights(const Candidates& candidates, const StepQuery& query, float* heights) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto most = hn::Set(d, query.radius_m * query.radius_m);
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto cx = hn::Set(d, query.centre.x), cy = hn::Set(d, query.centre.y),
             cz = hn::Set(d, query.centre.z);
  const auto px = hn::Set(d, query.plane.x), py = hn::Set(d, query.plane.y),
             pz = hn::Set(d, query.plane.z);
  auto lowest = infinity;
  auto highest = hn::Neg(infinity);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < candidates.count; i += lanes) {
    const auto x = hn::Sub(hn::LoadU(d, candidates.x + i), cx);
    const auto y = hn::Sub(hn::LoadU(d, candidates.y + i), cy);
    const auto z = hn::Sub(hn::LoadU(d, candidates.z + i), cz);
    const auto far = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    auto is_near = hn::Le(far, most);
    if (i + lanes > candidates.count) {
      is_near = hn::And(is_near, hn::FirstN(d, candidates.count - i));
    }
    const auto height = hn::Add(hn::Add(hn::Mul(x, px), hn::Mul(y, py)), hn::Mul(z, pz));
    lowest = hn::Min(lowest, hn::IfThenElse(is_near, height, infinity));
    highest = hn::Max(highest, hn::IfThenElse(is_near, height, hn::Neg(infinity)));
    const LanePacker pack(is_near);
    hn::StoreU(pack(height), d, heights + kept);
    kept += hn::CountTrue(d, is_near);
  }
  std::fill_n(heights + kept, kVectorPadding, std::numeric_limits<float>::infinity());
  return {kept, hn::GetLane(hn::MinOfLanes(d, lowest)), hn::GetLane(hn::MaxOfLanes(d, highest))};
}

// The smallest bound, in steps of 1/256 of all the difference, that at least `rank` do not exceed.
float height_of_rank(const float* heights, const KeptHeights& kept, std::size_t rank) {
  const Wide d;
  float low = kept.lowest;
  float high = kept.highest;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5F * (low + high);
    const auto bound = hn::Set(d, middle);
    std::size_t below = 0;
    for (std::size_t j = 0; j < kept.count; j += hn::Lanes(d)) {
      below += hn::CountTrue(d, hn::Le(hn::LoadU(d, heights + j), bound));
    }
    (below >= rank ? high : low) = middle;
  }
  return high;
}

float step_within_here(const Candidates& candidates, const StepQuery& query, Heights& room) {
  float* const heights = room.data();
  const KeptHeights kept = keep_heights(candidates, query, heights);
  if (kept.count < 2) return 0.0F;
  const std::size_t tail = kept.count / 20;
  return height_of_rank(heights, kept, kept.count - tail) - height_of_rank(heights, kept, tail + 1);
}

}  // namespace warren::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace warren {

HWY_EXPORT(step_within_here);

float step_within(const Candidates& candidates, const StepQuery& query, Heights& heights) {
  return HWY_DYNAMIC_DISPATCH(step_within_here)(candidates, query, heights);
}

}  // namespace warren
#endif
