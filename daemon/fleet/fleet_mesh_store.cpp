// SPDX-License-Identifier: Apache-2.0
// What FleetMesh stores, and takes over from a store.
#include <algorithm>
#include <utility>

#include "daemon/fleet/fleet_mesh.hpp"
#include "daemon/fleet/store_rows.hpp"
#include "daemon/log.hpp"

namespace warren {

using mesh::MeshRunner;

void FleetMesh::restore(StoredFleet stored) {
  for (const auto& [number, own] : map_.own_layers()) {
    poses_stored_[number] = own.layer().pose().origin().revision;
  }
  counters_before_ = std::move(stored.counters);
  for (auto& copy : stored.copies) {
    if (!replication_.restore_copy(std::move(copy))) ++copies_refused_;
  }
  if (!replication_.restore_logs(MeshRunner::now(), stored.logs)) {
    log_warning("fleet: more logs are stored than there is room for");
  }
  for (const replication::StoredLog& log : stored.logs) {
    for (const auto& [number, item] : log.items) {
      if (item) (void)read_status(log.id, number, *item);
    }
  }
}

// What is there at a time goes into one batch; the next waits for its end, and a moment.
void FleetMesh::commit(MeshTime now) {
  if (storing_ || now < committed_ + kBetweenCommits || !has_unstored()) return;
  storing_ = true;
  committed_ = now;
  const replication::StoreBatch batch = replication_.take_batch();
  StoreBatch rows = rows_of(batch);
  rows.self_layers = self_backlog_.take();
  if (now >= counters_at_) {
    rows.counters = counters();
    counters_at_ = now + kCountersEvery;
  }
  rows.is_behind = behind_said_ = store_is_behind_;
  add_moved(rows);
  store_.write(std::move(rows),
               [this, number = batch.number](bool stored) { on_committed(number, stored); });
}

std::map<std::string, std::uint64_t> FleetMesh::counters() {
  std::map<std::string, std::uint64_t> counters = counters_before_;
  counters["starts"] += 1;
  counters["batches_failed"] += batches_failed_;
  if (!runner_) return counters;
  const mesh::EndpointCounts counts = runner_->endpoint().counts();
  counters["packets_in"] += counts.packets_in;
  counters["ip_bytes_in"] += counts.ip_bytes_in;
  counters["packets_out"] += counts.packets_out;
  counters["ip_bytes_out"] += counts.ip_bytes_out;
  return counters;
}

// As of a store that was put back from a copy. It is told so, and its next start closes the layers.
void FleetMesh::look_for_older_store() {
  if (store_is_behind_ || replication_.ahead_of_us().empty()) return;
  store_is_behind_ = true;
  const auto& [layer, ahead] = *replication_.ahead_of_us().begin();
  log_error("fleet: " + name_of(ahead.holder) + " holds this node's layer " +
            std::to_string(layer.number) + " up to revision " + std::to_string(ahead.held.number) +
            ", and this node knew it up to " + std::to_string(ahead.known.number) +
            " only: the store is older than what has left this node. Restart warrend: it then "
            "begins a new layer; until then others may not get what is mapped here");
}

// Own layers that lie elsewhere now, whether or not anything in them changed: no revision of a pose
// may be used twice.
void FleetMesh::add_moved(StoreBatch& rows) {
  for (const auto& [number, own] : map_.own_layers()) {
    const Replica& layer = own.layer();
    const std::uint32_t revision = layer.pose().origin().revision;
    if (std::exchange(poses_stored_[number], revision) == revision) continue;
    const bool in_batch =
        std::any_of(rows.layers.begin(), rows.layers.end(),
                    [&](const LayerWrite& write) { return write.head.id == layer.id(); });
    if (!in_batch && replication_.book().find(layer.id()) != nullptr) {
      rows.layers.push_back(write_of(layer, true, {}));
    }
  }
}

void FleetMesh::on_committed(std::uint64_t batch, bool stored) {
  storing_ = false;
  ++(stored ? batches_stored_ : batches_failed_);
  if (stored) {
    replication_.on_stored(MeshRunner::now(), batch);
    self_backlog_.on_stored();
  } else {
    replication_.on_refused(batch);
    self_backlog_.on_refused();
    behind_said_ = false;
    poses_stored_.clear();
    committed_ = MeshRunner::now() + kAfterRefusal;
  }
  desk_.on_committed(MeshRunner::now(), stored);
  if (stored) speak(MeshRunner::now());
  turn_soon();
}

// Those that came before the layer was known.
void FleetMesh::take_poses(Replica& copy) {
  for (const auto& held : replication_.log_book().logs()) {
    for (const auto& [number, item] : held->log.items()) {
      const auto pose = replication::read_layer_pose(item);
      if (!pose || pose->correction || pose->layer != copy.id()) continue;
      (void)copy.pose().update_origin(pose->pose);
    }
  }
}

}  // namespace warren
