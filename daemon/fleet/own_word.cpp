// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/own_word.hpp"

#include <algorithm>

namespace warren {

bool OwnWord::differs(const std::optional<NodeStatus>& told, const NodeStatus& status) {
  if (!told || told->name != status.name || told->role != status.role ||
      told->layer != status.layer ||
      told->position_fleet.has_value() != status.position_fleet.has_value()) {
    return true;
  }
  return status.position_fleet &&
         (*status.position_fleet - *told->position_fleet).norm() > kMoved_m;
}

bool OwnWord::cannot_wait(MeshTime now, const NodeStatus& status) const {
  if (!told_neighbours_ || told_neighbours_->name != status.name ||
      told_neighbours_->role != status.role ||
      told_neighbours_->layer.has_value() != status.layer.has_value() ||
      (status.layer && told_neighbours_->layer->id != status.layer->id)) {
    return true;
  }
  return now >= changed_ + kStillTicks * tick_ ||
         now >= told_neighbours_at_ + std::min<Duration>(kEveryMax, kEveryTicks * tick_);
}

OwnWord::Tell OwnWord::judge(MeshTime now, const NodeStatus& status, bool last) {
  if (differs(previous_, status)) {
    previous_ = status;
    changed_ = now;
  }
  Tell tell;
  tell.neighbours = differs(told_neighbours_, status) && (last || cannot_wait(now, status));
  tell.fleet =
      differs(told_fleet_, status) && (!told_fleet_ || last || now >= told_fleet_at_ + kItemEvery);
  if (tell.neighbours) {
    told_neighbours_ = status;
    told_neighbours_at_ = now;
  }
  if (tell.fleet) {
    told_fleet_ = status;
    told_fleet_at_ = now;
  }
  return tell;
}

}  // namespace warren
