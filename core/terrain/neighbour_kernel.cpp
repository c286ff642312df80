// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/neighbour_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/neighbour_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/terrain/lane_packer-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace warren::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<float>;
// Sums run in eight lanes on every target, and so round alike.
inline constexpr std::size_t kSumLanes = 8;
using Narrow = hn::CappedTag<float, kSumLanes>;

// Keeps the candidates within the squared distance `limit`; returns how many.
template <bool kNumbered>
std::size_t keep_near(const Candidates& candidates, const Point3f& centre, float limit,
                      NearCandidates& near) {
  const Wide d;
  const hn::Rebind<std::int32_t, Wide> di;
  const std::size_t lanes = hn::Lanes(d);
  const auto cx = hn::Set(d, centre.x);
  const auto cy = hn::Set(d, centre.y);
  const auto cz = hn::Set(d, centre.z);
  const auto most = hn::Set(d, limit);
  float* const squared = near.squared();
  float* const x = near.x();
  float* const y = near.y();
  float* const z = near.z();
  float* const number = near.number();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < candidates.count; i += lanes) {
    const auto dx = hn::Sub(hn::LoadU(d, candidates.x + i), cx);
    const auto dy = hn::Sub(hn::LoadU(d, candidates.y + i), cy);
    const auto dz = hn::Sub(hn::LoadU(d, candidates.z + i), cz);
    const auto far = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    auto is_near = hn::Le(far, most);
    if (HWY_UNLIKELY(i + lanes > candidates.count)) {
      is_near = hn::And(is_near, hn::FirstN(d, candidates.count - i));
    }
    const LanePacker pack(is_near);
    hn::StoreU(pack(far), d, squared + kept);
    hn::StoreU(pack(dx), d, x + kept);
    hn::StoreU(pack(dy), d, y + kept);
    hn::StoreU(pack(dz), d, z + kept);
    if constexpr (kNumbered) {
      const auto numbers = hn::BitCast(d, hn::Iota(di, static_cast<std::int32_t>(i)));
      hn::StoreU(pack(numbers), d, number + kept);
    }
    kept += hn::CountTrue(d, is_near);
  }
  std::fill_n(squared + kept, kVectorPadding, std::numeric_limits<float>::infinity());
  return kept;
}

std::size_t count_within(const float* squared, std::size_t count, float limit) {
  const Wide d;
  const auto most = hn::Set(d, limit);
  std::size_t within = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    within += hn::CountTrue(d, hn::Le(hn::LoadU(d, squared + i), most));
  }
  return within;
}

// Leaves out all but the first of those that lie exactly at the limit.
void drop_last_ties(float* squared, std::size_t count, float limit, std::size_t surplus) {
  for (std::size_t i = count; i-- > 0 && surplus > 0;) {
    if (squared[i] != limit) continue;
    squared[i] = std::numeric_limits<float>::infinity();
    --surplus;
  }
}

// A squared distance that exactly k of the kept do not exceed; `limit` holds them all. Guesses by
// interpolation (on a surface the count grows with the square), then halves what is left: squares
// are not negative, so their bits are in their order.
float limit_of_k(float* squared, std::size_t kept, std::size_t k, float limit) {
  if (kept == k) return limit;
  std::int32_t low = -1;  // fewer than k are within
  std::int32_t high = std::bit_cast<std::int32_t>(limit);
  std::size_t within_low = 0;
  std::size_t within_high = kept;
  for (int round = 0; high - low > 1; ++round) {
    std::int32_t middle = low + (high - low) / 2;
    if (round < 6) {
      const float from = low < 0 ? 0.0F : std::bit_cast<float>(low);
      const float share = (static_cast<float>(k - within_low) + 0.5F) /
                          static_cast<float>(within_high - within_low);
      const float guess = from + (std::bit_cast<float>(high) - from) * share;
      middle = std::clamp(std::bit_cast<std::int32_t>(guess), low + 1, high - 1);
    }
    const std::size_t within = count_within(squared, kept, std::bit_cast<float>(middle));
    if (within == k) return std::bit_cast<float>(middle);
    (within < k ? low : high) = middle;
    (within < k ? within_low : within_high) = within;
  }
  const auto tied = std::bit_cast<float>(high);
  drop_last_ties(squared, kept, tied, within_high - k);
  return tied;
}

// Candidates within some radius that holds at least k.
template <bool kNumbered>
std::size_t keep_at_least_k(const Candidates& candidates, const NearestQuery& query, float& limit,
                            NearCandidates& near) {
  limit = query.guess;
  std::size_t kept = keep_near<kNumbered>(candidates, query.centre, limit, near);
  if (kept >= query.k) return kept;
  limit = std::numeric_limits<float>::max();
  kept = keep_near<kNumbered>(candidates, query.centre, limit, near);
  assert(kept >= query.k);
  // All of them: the farthest is a better start than no limit at all.
  limit = *std::max_element(near.squared(), near.squared() + kept);
  return kept;
}

NearestSums sums_within(NearCandidates& near, std::size_t kept, float limit) {
  const Narrow d;
  const std::size_t lanes = hn::Lanes(d);
  const auto most = hn::Set(d, limit);
  const float* const squared = near.squared();
  const float* const all_x = near.x();
  const float* const all_y = near.y();
  const float* const all_z = near.z();
  alignas(64) float sums[10][kSumLanes];
  for (std::size_t part = 0; part < kSumLanes; part += lanes) {
    auto sx = hn::Zero(d), sy = sx, sz = sx, farthest = sx;
    auto sxx = sx, sxy = sx, sxz = sx, syy = sx, syz = sx, szz = sx;
    for (std::size_t i = part; i < kept; i += kSumLanes) {
      const auto far = hn::LoadU(d, squared + i);
      const auto is_near = hn::Le(far, most);
      const auto x = hn::IfThenElseZero(is_near, hn::LoadU(d, all_x + i));
      const auto y = hn::IfThenElseZero(is_near, hn::LoadU(d, all_y + i));
      const auto z = hn::IfThenElseZero(is_near, hn::LoadU(d, all_z + i));
      farthest = hn::Max(farthest, hn::IfThenElseZero(is_near, far));
      sx = hn::Add(sx, x);
      sy = hn::Add(sy, y);
      sz = hn::Add(sz, z);
      sxx = hn::Add(sxx, hn::Mul(x, x));
      sxy = hn::Add(sxy, hn::Mul(x, y));
      sxz = hn::Add(sxz, hn::Mul(x, z));
      syy = hn::Add(syy, hn::Mul(y, y));
      syz = hn::Add(syz, hn::Mul(y, z));
      szz = hn::Add(szz, hn::Mul(z, z));
    }
    hn::StoreU(sx, d, sums[0] + part);
    hn::StoreU(sy, d, sums[1] + part);
    hn::StoreU(sz, d, sums[2] + part);
    hn::StoreU(sxx, d, sums[3] + part);
    hn::StoreU(sxy, d, sums[4] + part);
    hn::StoreU(sxz, d, sums[5] + part);
    hn::StoreU(syy, d, sums[6] + part);
    hn::StoreU(syz, d, sums[7] + part);
    hn::StoreU(szz, d, sums[8] + part);
    hn::StoreU(farthest, d, sums[9] + part);
  }
  NearestSums result;
  for (std::size_t i = 0; i < result.moments.size(); ++i) {
    const float* const s = sums[i];
    result.moments[i] = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
  }
  result.squared_radius = *std::max_element(sums[9], sums[9] + kSumLanes);
  return result;
}

NearestSums find_nearest_here(const Candidates& candidates, const NearestQuery& query,
                              NearCandidates& near) {
  float limit = 0.0F;
  const std::size_t kept = keep_at_least_k<false>(candidates, query, limit, near);
  return sums_within(near, kept, limit_of_k(near.squared(), kept, query.k, limit));
}

void list_nearest_here(const Candidates& candidates, const NearestQuery& query,
                       NearCandidates& near, std::span<std::uint32_t> numbers) {
  float limit = 0.0F;
  const std::size_t kept = keep_at_least_k<true>(candidates, query, limit, near);
  limit = limit_of_k(near.squared(), kept, query.k, limit);
  std::size_t listed = 0;
  for (std::size_t i = 0; i < kept; ++i) {
    if (near.squared()[i] <= limit)
      numbers[listed++] = std::bit_cast<std::uint32_t>(near.number()[i]);
  }
}

}  // namespace warren::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace warren {

HWY_EXPORT(find_nearest_here);
HWY_EXPORT(list_nearest_here);

void NearCandidates::reserve(std::size_t candidates) {
  const std::size_t row = candidates + 2 * kVectorPadding;
  if (row <= row_) return;
  row_ = row;
  rows_.resize(5 * row_);
}

NearestSums find_nearest(const Candidates& candidates, const NearestQuery& query,
                         NearCandidates& near) {
  assert(query.k > 0 && query.k <= candidates.count);
  return HWY_DYNAMIC_DISPATCH(find_nearest_here)(candidates, query, near);
}

void list_nearest(const Candidates& candidates, const NearestQuery& query, NearCandidates& near,
                  std::span<std::uint32_t> numbers) {
  assert(query.k > 0 && query.k <= candidates.count && numbers.size() == query.k);
  HWY_DYNAMIC_DISPATCH(list_nearest_here)(candidates, query, near, numbers);
}

}  // namespace warren
#endif
