// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/ground.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "core/voxel/voxel_ray.hpp"

namespace warren {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kFarthest_m = 1e6;

std::size_t columns_along(double edge_m, double resolution_m) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(edge_m / (resolution_m / 2.0))));
}

// The columns of a footprint, row by row.
class Columns {
 public:
  Columns(const TerrainView& map, const GroundQuery& query)
      : map_(map),
        query_(query),
        along_(columns_along(query.footprint.length_m, map.lattice().resolution_m())),
        across_(columns_along(query.footprint.width_m, map.lattice().resolution_m())) {}

  GroundReport report() {
    heights_m_.assign(along_ * across_, kNone);
    for (std::size_t i = 0; i < along_; ++i) {
      for (std::size_t j = 0; j < across_; ++j) {
        if (const auto key = ground_under(start_of(i, j))) add(*key, heights_m_[i * across_ + j]);
      }
    }
    report_.columns = heights_m_.size();
    const auto share = [this](std::size_t part) {
      return static_cast<double>(part) / static_cast<double>(report_.columns);
    };
    report_.unknown_share = share(report_.columns - report_.columns_with_cost);
    report_.stairs_share = share(stairs_);
    if (report_.columns_with_cost > 0) {
      report_.mean_cost = cost_sum_ / static_cast<double>(report_.columns_with_cost);
    }
    report_.step_m = greatest_step_m();
    return report_;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  Eigen::Vector3d start_of(std::size_t i, std::size_t j) const {
    const auto place = [](std::size_t at, std::size_t count, double edge_m) {
      return ((static_cast<double>(at) + 0.5) / static_cast<double>(count) - 0.5) * edge_m;
    };
    const Eigen::Vector3d in_base(place(i, along_, query_.footprint.length_m),
                                  place(j, across_, query_.footprint.width_m), 0.0);
    return query_.T_layer_base * in_base - query_.gravity * query_.above_m;
  }

  std::optional<VoxelKey> ground_under(const Eigen::Vector3d& start) const {
    const auto first = map_.lattice().key_of(start.x(), start.y(), start.z());
    if (!first) return std::nullopt;
    const Eigen::Vector3d& down = query_.gravity;
    const double length_m = query_.above_m + query_.below_m;
    VoxelRay ray(map_.lattice(), *first, {start.x(), start.y(), start.z()},
                 {down.x(), down.y(), down.z()});
    for (; ray.entered_m() <= length_m && ray.in_key_space(); ray.advance()) {
      if (map_.state(ray.key()) == VoxelState::kOccupied) return ray.key();
    }
    return std::nullopt;
  }

  void add(const VoxelKey& key, double& height_m) {
    const Lattice& lattice = map_.lattice();
    const Eigen::Vector3d centre(lattice.centre_m(key.x), lattice.centre_m(key.y),
                                 lattice.centre_m(key.z));
    height_m = -centre.dot(query_.gravity);
    ++report_.columns_with_ground;
    stairs_ += map_.is_stair(key) ? 1 : 0;
    const auto cost = map_.cost(key);
    if (!cost) return;
    ++report_.columns_with_cost;
    cost_sum_ += static_cast<double>(*cost);
    report_.max_cost = std::max(report_.max_cost.value_or(0.0), static_cast<double>(*cost));
  }

  // Comparisons with a column that has no ground are false.
  double greatest_step_m() const {
    double greatest = 0.0;
    for (std::size_t i = 0; i < along_; ++i) {
      for (std::size_t j = 0; j < across_; ++j) {
        const double here = heights_m_[i * across_ + j];
        const double ahead = i + 1 < along_ ? heights_m_[(i + 1) * across_ + j] : kNone;
        const double beside = j + 1 < across_ ? heights_m_[i * across_ + j + 1] : kNone;
        for (const double difference : {std::abs(ahead - here), std::abs(beside - here)}) {
          if (difference > greatest) greatest = difference;
        }
      }
    }
    return greatest;
  }

  const TerrainView& map_;
  const GroundQuery& query_;
  std::size_t along_;
  std::size_t across_;
  std::vector<double> heights_m_;  // against gravity
  GroundReport report_;
  std::size_t stairs_ = 0;
  double cost_sum_ = 0.0;
};

}  // namespace

// A column with no reach looks into one voxel all the same.
double GroundQuery::voxels(double resolution_m) const {
  const double columns = static_cast<double>(columns_along(footprint.length_m, resolution_m)) *
                         static_cast<double>(columns_along(footprint.width_m, resolution_m));
  return columns * (1.0 + (above_m + below_m) / resolution_m);
}

bool GroundQuery::makes_sense() const {
  const auto in_reach = [](double length_m) { return length_m >= 0.0 && length_m <= 100.0; };
  return footprint.length_m > 0.0 && footprint.width_m > 0.0 && in_reach(footprint.length_m) &&
         in_reach(footprint.width_m) && in_reach(above_m) && in_reach(below_m) &&
         std::abs(gravity.norm() - 1.0) < kUnitTolerance && T_layer_base.matrix().allFinite() &&
         T_layer_base.translation().cwiseAbs().maxCoeff() < kFarthest_m;
}

GroundReport ground(const TerrainView& map, const GroundQuery& query) {
  assert(query.is_valid(map.lattice().resolution_m()));
  return Columns(map, query).report();
}

const char* name_of(Validity validity) {
  switch (validity) {
    case Validity::kTraversable:
      return "traversable";
    case Validity::kStairs:
      return "stairs";
    case Validity::kUnknown:
      return "unknown";
    case Validity::kTooHard:
      return "too_hard";
  }
  return "unknown";
}

Validity validity(const GroundReport& report, bool stair_capable, const ValidityRule& rule) {
  if (stair_capable && report.stairs_share >= rule.stairs_from) return Validity::kStairs;
  if (!report.mean_cost) return Validity::kUnknown;
  if (*report.mean_cost >= rule.mean_below || *report.max_cost >= rule.max_below) {
    return Validity::kTooHard;
  }
  const double mean_with_unknown =
      *report.mean_cost * (1.0 - report.unknown_share) + report.unknown_share;
  const bool known_enough =
      report.unknown_share <= rule.unknown_up_to && mean_with_unknown < rule.mean_below;
  return known_enough ? Validity::kTraversable : Validity::kUnknown;
}

Validity validity(const TerrainView& map, const GroundQuery& query, bool stair_capable,
                  const ValidityRule& rule) {
  return validity(ground(map, query), stair_capable, rule);
}

}  // namespace warren
