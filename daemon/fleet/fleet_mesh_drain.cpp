// SPDX-License-Identifier: Apache-2.0
// How FleetMesh ends: neighbours get what is stored here.
#include <utility>

#include "daemon/fleet/fleet_mesh.hpp"
#include "daemon/fleet/wall_clock.hpp"
#include "daemon/replication/holdings_walk.hpp"

namespace warren {
namespace {

using mesh::MeshRunner;

constexpr std::size_t kPacketBytes = 1200;

// Whether this member lacks something of the layer that it wants, or has not acknowledged it.
bool lacks(const replication::Subscription& subscription, const replication::HeldLayer& layer) {
  if (!subscription.wanted() || !layer.may_be_told()) return false;
  const Replica& replica = layer.replica();
  if (subscription.under_way() > 0 || subscription.next_fresh(replica, kPacketBytes)) return true;
  return subscription.wants_everything() &&
         replication::holds_more(replica.holdings(), subscription.believed());
}

}  // namespace

void FleetMesh::drain(Duration at_most, std::function<void()> done) {
  drain_until_ = MeshRunner::now() + at_most;
  committed_ = std::min(committed_, MeshRunner::now() - kBetweenCommits);
  counters_at_ = kAtOnce;
  drained_ = std::move(done);
  speak(MeshRunner::now());
  desk_.on_ticked(MeshRunner::now(), wall_clock_us(), true);
  turn_soon();
}

// Whatever neighbours lack, what this node knows is stored, if the disk takes it.
bool FleetMesh::is_drained(MeshTime now) const {
  if (storing_ || has_unstored()) return now >= drain_until_ + kStoreLast;
  if (now >= drain_until_) return true;
  const auto& layers = replication_.book().layers();
  for (const auto& [id, peer] : replication_.peers()) {
    if (!peer.up) continue;
    for (const auto& [slot, subscription] : peer.subscriptions) {
      if (slot < layers.size() && lacks(subscription, *layers[slot])) return false;
    }
  }
  return true;
}

}  // namespace warren
