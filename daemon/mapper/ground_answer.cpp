// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/ground_answer.hpp"

#include <cmath>

namespace warren {

bool normalise(Eigen::Vector3d& gravity) {
  const double length = gravity.stableNorm();
  if (!std::isfinite(length) || length == 0.0) return false;
  gravity /= length;
  return gravity.allFinite();
}

tl::expected<GroundAnswer, std::string> answer_ground(const TerrainView& view,
                                                      const Eigen::Vector3d& origin_map,
                                                      const Eigen::Vector3d& gravity_map,
                                                      const GroundQuestion& question) {
  const auto T_map_base = question.T_map_base.checked();
  if (!T_map_base) return tl::unexpected(std::string("the pose is not rigid or not finite"));
  GroundQuery query;
  query.T_layer_base = *T_map_base;
  query.T_layer_base.translation() -= origin_map;
  query.footprint = question.footprint;
  query.gravity = question.gravity_map.value_or(gravity_map);
  query.above_m = question.above_m.value_or(query.above_m);
  query.below_m = question.below_m.value_or(query.below_m);
  if (!normalise(query.gravity) || !query.makes_sense()) {
    return tl::unexpected(std::string("the footprint, reach or gravity make no sense"));
  }
  if (query.voxels(view.lattice().resolution_m()) > GroundQuery::kVoxelsMax) {
    return tl::unexpected(
        std::string("the columns are over 131072 voxels long together: ask for a smaller "
                    "footprint, or for less reach"));
  }
  GroundAnswer answer;
  answer.ground = ground(view, query);
  ValidityRule rule;
  rule.unknown_up_to = question.unknown_up_to;
  answer.validity = validity(answer.ground, question.stair_capable, rule);
  return answer;
}

}  // namespace warren
