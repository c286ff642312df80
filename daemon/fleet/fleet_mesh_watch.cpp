// SPDX-License-Identifier: Apache-2.0
// What FleetMesh warns the operator of.
#include <chrono>
#include <utility>

#include "daemon/fleet/fleet_mesh.hpp"
#include "daemon/log.hpp"

namespace warren {

void FleetMesh::watch_conflicts() {
  const auto judged = conflicts_.advance(map_);
  if (!judged) return;
  const double score = *conflicts_.score(*judged);
  const ConflictLevel level = level_of(score);
  const ConflictLevel before = std::exchange(conflict_levels_[*judged], level);
  if (level <= before) return;
  log_warning("fleet: a map of " + name_of({judged->origin}) +
              " contradicts this node's own: " + std::to_string(static_cast<int>(100.0 * score)) +
              " % of its obstacles are free here; " +
              (level == ConflictLevel::kMisleading ? "retract it, or move it where it belongs"
                                                   : "move it where it belongs"));
}

// Everybody takes the two for one, which restarts again and again.
void FleetMesh::watch_own_name() {
  if (!runner_) return;
  const std::uint64_t came = runner_->endpoint().counts()[mesh::Unused::kOwnMember];
  if (std::exchange(own_member_came_, came) == came) return;
  if (!own_name_throttle_.allows(std::chrono::steady_clock::now())) return;
  log_warning("fleet: another node is called " + config_.name +
              " as well; stop it, or give it another node.name");
}

}  // namespace warren
