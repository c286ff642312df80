// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/cell.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "tests/sim/measures.hpp"

namespace warren::fleet_sim {
namespace {

constexpr Duration kBefore = std::chrono::seconds(15);  // until all know each other

FleetConfig config_of(const Cell& cell) {
  FleetConfig config;
  config.mesh.nodes = cell.nodes;
  config.mesh.seed = cell.seed;
  config.mesh.check_datagrams = false;
  config.mesh.interface.group_broadcast = cell.broadcast;
  LinkModelConfig& network = config.mesh.networks.front();
  network.shared_airtime = true;
  network.queue.time = std::chrono::milliseconds(500);
  network.link.capacity = Capacity(cell.rate_bit_s);
  network.link.delay = std::chrono::milliseconds(2);
  network.link.loss = cell.loss;
  config.walker = cell.walker;
  config.tick = cell.tick;
  for (std::size_t i = 0; i < cell.nodes; ++i) config.writes.push_back(i < cell.writers);
  return config;
}

void cut_to_line(Fleet& fleet, const Cell& cell) {
  LinkConfig dead;
  dead.capacity = Capacity(cell.rate_bit_s);
  dead.loss = 1.0;
  for (std::size_t a = 0; a < cell.nodes; ++a) {
    for (std::size_t b = 0; b < cell.nodes; ++b) {
      if (a == b || a + 1 == b || b + 1 == a) continue;
      fleet.mesh().network().set_link(fleet.now(), static_cast<StationIndex>(a),
                                      static_cast<StationIndex>(b), dead);
    }
  }
}

struct Sums {
  std::uint64_t air_bytes = 0;
  std::uint64_t telemetry = 0;
  std::uint64_t fresh = 0;
  std::uint64_t backlog = 0;
  std::uint64_t group = 0;
  std::uint64_t wishes = 0;
};

Sums sums_of(Fleet& fleet) {
  Sums sums;
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    const auto& counts = fleet.mesh().node(i).endpoint->counts();
    sums.air_bytes += fleet.mesh().network().counts(static_cast<StationIndex>(i)).sent_bytes;
    sums.telemetry += counts[mesh::SentClass::kTelemetry].bytes;
    sums.fresh += counts[mesh::SentClass::kFresh].bytes;
    sums.backlog += counts[mesh::SentClass::kBacklog].bytes;
    sums.group += counts[mesh::SentClass::kGroup].bytes;
    sums.wishes += fleet.node(i).replication->refused().wishes_for_lost;
  }
  return sums;
}

// What it takes to tell each tick once, and the voxels told.
struct Told {
  std::uint64_t bytes = 0;
  std::uint64_t voxels = 0;
};
Told told_since(Fleet& fleet, std::vector<Revision>& revisions) {
  Told told;
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    if (fleet.node(i).own.empty()) continue;
    const Replica& layer = *fleet.node(i).own.back();
    const Revision now = layer.holdings().at(0);
    if (now == revisions[i]) continue;
    for_each_packet(layer, {{}, revisions[i], 1300}, [&](DiffPacket& packet) {
      told.bytes += packet.bytes.size();
      return true;
    });
    layer.for_each_changed({}, revisions[i], [&](BlockOrdinal, const LayerBlock& block) {
      for (const std::uint64_t cell : block.history.changed_since(revisions[i])) {
        told.voxels += static_cast<std::uint64_t>(std::popcount(cell));
      }
      return true;
    });
    revisions[i] = now;
  }
  return told;
}

// How long ago everybody's copies were what their writers have now.
void note_lags(Fleet& fleet, std::vector<double>& lags) {
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    for (const auto& layer : fleet.node(i).replication->book().layers()) {
      if (layer->own != nullptr) continue;
      const auto writer = fleet.mesh().nodes() > layer->id.origin - 1
                              ? fleet.node(layer->id.origin - 1).replication.get()
                              : nullptr;
      const auto* const own = std::as_const(*writer).book().find(layer->id);
      const auto since = own->times.since(layer->replica().holdings().lowest({}));
      lags.push_back(since ? mesh::in_seconds(fleet.now() - *since) : 0.0);
    }
  }
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

CellUse measure(const Cell& cell) {
  Fleet fleet(config_of(cell));
  if (cell.line) cut_to_line(fleet, cell);
  fleet.start_all();
  fleet.mesh().run_until(MeshTime(kBefore));
  std::vector<Revision> revisions(cell.nodes);
  (void)told_since(fleet, revisions);
  const Sums before = sums_of(fleet);
  Told told;
  std::vector<double> lags;
  for (Duration at{}; at < cell.time; at += cell.tick) {
    fleet.mesh().run_until(fleet.now() + cell.tick);
    const Told tick = told_since(fleet, revisions);
    told.bytes += tick.bytes;
    told.voxels += tick.voxels;
    note_lags(fleet, lags);
  }
  const Sums after = sums_of(fleet);
  const auto share = [&](std::uint64_t now, std::uint64_t then) {
    return static_cast<double>(now - then) /
           static_cast<double>(after.air_bytes - before.air_bytes);
  };
  const auto air = static_cast<double>(after.air_bytes - before.air_bytes);
  const double seconds = mesh::in_seconds(cell.time);
  CellUse use;
  use.airtime_share = air * 8.0 / cell.rate_bit_s / seconds;
  use.bytes_per_voxel =
      air / (static_cast<double>(told.voxels) * static_cast<double>(cell.nodes - 1));
  use.copies = air / static_cast<double>(told.bytes);
  use.telemetry_share = share(after.telemetry, before.telemetry);
  use.fresh_share = share(after.fresh, before.fresh);
  use.backlog_share = share(after.backlog, before.backlog);
  use.group_share = share(after.group, before.group);
  use.wishes = static_cast<double>(after.wishes - before.wishes) * 60.0 / seconds /
               static_cast<double>(cell.nodes);
  use.lag_s_p50 = quantile(lags, 0.5);
  use.lag_s_p95 = quantile(lags, 0.95);
  return use;
}

}  // namespace warren::fleet_sim
