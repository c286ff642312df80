// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/own_word.hpp"

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

OwnWord::Tell OwnWord::judge(MeshTime now, const NodeStatus& status, bool last) {
  Tell tell;
  tell.neighbours = differs(told_neighbours_, status);
  tell.fleet =
      differs(told_fleet_, status) && (!told_fleet_ || last || now >= told_fleet_at_ + kItemEvery);
  if (tell.neighbours) told_neighbours_ = status;
  if (tell.fleet) {
    told_fleet_ = status;
    told_fleet_at_ = now;
  }
  return tell;
}

}  // namespace warren
