// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/voxel_cost_gatherer.hpp"

namespace warren {
namespace {

std::uint64_t code_of(const VoxelKey& key) {
  const auto axis = [](std::int32_t k) { return static_cast<std::uint32_t>(k - kKeyMin); };
  return packed({axis(key.x), axis(key.y), axis(key.z)});
}

float information_at(float squared_range) {
  constexpr float kHalf = VoxelCostGatherer::kHalfInformationRange_m;
  return 1.0F / (1.0F + squared_range / (kHalf * kHalf));
}

}  // namespace

std::span<const VoxelCost> VoxelCostGatherer::gather(std::span<const JudgedPoint> points,
                                                     const Point3f& origin_layer,
                                                     const Lattice& lattice) {
  numbers_.reset(costs_.size());
  last_code_ = 0;
  sums_.clear();
  costs_.clear();
  for (const JudgedPoint& point : points) {
    if (!point.has_cost()) continue;
    const auto key = lattice.key_of(point.position_layer);
    if (!key) continue;
    Sum& sum = sums_[number_of(*key)];
    sum.cost += point.cost;
    ++sum.points;
  }
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    costs_[i].cost = sums_[i].cost / static_cast<float>(sums_[i].points);
    costs_[i].information =
        information_at(squared_distance(lattice.centre(costs_[i].key), origin_layer));
  }
  return costs_;
}

// A new voxel gets the next number and an empty sum.
std::uint32_t VoxelCostGatherer::number_of(const VoxelKey& key) {
  const std::uint64_t code = code_of(key);
  if (code == last_code_) return last_number_;
  const auto fresh = static_cast<std::uint32_t>(costs_.size());
  last_code_ = code;
  last_number_ = numbers_.find_or_add(code, fresh);
  if (last_number_ == fresh) {
    sums_.push_back({});
    costs_.push_back({key, 0.0F, 0.0F});
  }
  return last_number_;
}

}  // namespace warren
