// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/own_path.hpp"

#include <utility>

namespace warren {

void OwnPath::begin(const LayerId& layer, std::uint32_t next_number) {
  layer_ = layer;
  open_ = {layer, next_number, {}};
  before_.reset();
  told_points_ = 0;
}

bool OwnPath::is_worth_a_point(MeshTime now, const PathPoint& point) const {
  if (!point.position_layer.allFinite() ||
      point.position_layer.cwiseAbs().maxCoeff() > kPathReach_m) {
    return false;
  }
  if (!before_) return true;
  const double moved_m = (point.position_layer - before_->position_layer).norm();
  return moved_m >= kStep_m || (moved_m >= kStir_m && now >= before_at_ + kEvery);
}

std::optional<PathChunk> OwnPath::note(MeshTime now, const PathPoint& point, bool last) {
  if (is_worth_a_point(now, point)) {
    open_.points.push_back(point);
    before_ = point;
    before_at_ = now;
  }
  const bool full = open_.points.size() == PathChunk::kPointsMax;
  const bool has_news = open_.points.size() > told_points_;
  const bool due = full || last || !told_at_ || now >= *told_at_ + kEvery;
  if (!has_news || !due) return std::nullopt;
  told_at_ = now;
  told_points_ = open_.points.size();
  std::optional<PathChunk> told(open_);
  if (full) {
    open_ = {*layer_, open_.number + 1, {}};
    told_points_ = 0;
  }
  return told;
}

}  // namespace warren
