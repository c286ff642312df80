// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/peer_paths.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

constexpr double kStaleCost = 2.0;
constexpr double kCostPerSecondOfRtt = 0.2;
constexpr double kBeaconGain = 0.15;
// What a period is on average, in units of the longest (BeaconClock).
constexpr double kMeanPeriod = 0.9;

}  // namespace

bool PeerPaths::on_pair_packet(MeshTime now, const MeshPath& from, bool newest) {
  Path& path = paths_[from.interface];
  path.heard = now;
  if (path.address == from.address) path.address_heard = now;
  if (!newest) return false;
  const bool other_address = path.address != from.address;
  if (other_address) {
    path.address = from.address;
    path.address_heard = now;
    path.size = {};
  }
  if (!current_) {
    current_ = from.interface;
    return false;
  }
  return (other_address && *current_ == from.interface) || choose(now);
}

void PeerPaths::on_beacon(MeshTime now, const MeshPath& from, Duration period) {
  Path& path = paths_[from.interface];
  if (path.beacon != MeshTime::min()) {
    const double expected = std::chrono::duration<double>(now - path.beacon).count() /
                            (kMeanPeriod * std::chrono::duration<double>(path.period).count());
    const double lost = expected <= 1.5 ? 0.0 : 1.0 - 1.0 / expected;
    path.beacon_loss += kBeaconGain * (lost - path.beacon_loss);
  }
  path.beacon = path.heard = now;
  if (path.address == from.address) path.address_heard = now;
  // What the flow knew of it is of long ago.
  if (current_ != from.interface) path.loss += kBeaconGain * (path.beacon_loss - path.loss);
  path.period = std::max(period, Duration(std::chrono::milliseconds(100)));
}

void PeerPaths::note_quality(double loss, Duration rtt) {
  if (!current_) return;
  paths_[*current_].loss = loss;
  paths_[*current_].rtt = rtt;
}

double PeerPaths::cost(const Path& path, MeshTime now) {
  const Duration stale_after = std::max(kStaleLeast, 5 * path.period / 2);
  const bool stale = path.heard == MeshTime::min() || now - path.heard > stale_after;
  return std::max(path.loss, path.beacon_loss) +
         kCostPerSecondOfRtt * std::chrono::duration<double>(path.rtt).count() +
         (stale ? kStaleCost : 0.0);
}

bool PeerPaths::choose(MeshTime now) {
  if (!current_ || paths_.size() < 2) return false;
  const double present = cost(paths_[*current_], now);
  std::size_t best = *current_;
  double best_cost = present - kBetterBy;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (!paths_[i].address || i == *current_) continue;
    const double other = cost(paths_[i], now);
    if (other < best_cost) {
      best = i;
      best_cost = other;
    }
  }
  if (best == *current_) return false;
  current_ = static_cast<InterfaceIndex>(best);
  return true;
}

bool PeerPaths::take_probe(MeshTime now, const MeshPath& from) {
  Path& path = paths_[from.interface];
  if (path.address == from.address) return false;
  // It has several addresses here, and one of them is proved.
  if (path.address && now - path.address_heard < kStaleLeast) return false;
  if (path.probed != MeshTime::min() && now - path.probed < kProbeLeast) return false;
  path.probed = now;
  return true;
}

void PeerPaths::reset() {
  for (Path& path : paths_) path = {};
  current_.reset();
}

std::optional<MeshPath> PeerPaths::current() const {
  if (!current_) return std::nullopt;
  return MeshPath{*current_, false, *paths_[*current_].address};
}

}  // namespace warren::mesh
