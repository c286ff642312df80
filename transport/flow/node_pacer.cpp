// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/node_pacer.hpp"

#include <algorithm>
#include <cmath>

namespace warren::mesh {
namespace {

constexpr Duration kBurst = std::chrono::milliseconds{2};

Duration airtime(std::size_t ip_bytes, double rate) {
  return Duration{std::llround(static_cast<double>(ip_bytes) * 1e6 / std::max(rate, 1.0))};
}

}  // namespace

void NodePacer::want(Peer peer, bool wants) {
  if (wants) {
    shares_[peer].wants = true;
  } else if (const auto share = shares_.find(peer); share != shares_.end()) {
    share->second.wants = false;
    // Who rests saves nothing up; what it overdrew it still owes.
    share->second.deficit = std::min(share->second.deficit, Duration{0});
  }
}

bool NodePacer::wants(Peer peer) const {
  const auto share = shares_.find(peer);
  return share != shares_.end() && share->second.wants;
}

std::optional<NodePacer::Peer> NodePacer::next(MeshTime now) {
  if (now < ready_at_) return {};
  // The richest in airtime among those that want; on a tie the one after the last.
  std::optional<Peer> best;
  const auto better = [&](const auto& candidate) {
    return !best || candidate.second.deficit > shares_[*best].deficit;
  };
  const auto after_last = turn_ ? shares_.upper_bound(*turn_) : shares_.begin();
  for (auto share = after_last; share != shares_.end(); ++share) {
    if (share->second.wants && better(*share)) best = share->first;
  }
  for (auto share = shares_.begin(); share != after_last; ++share) {
    if (share->second.wants && better(*share)) best = share->first;
  }
  return best;
}

bool NodePacer::on_sent(MeshTime now, std::optional<Peer> peer, std::size_t ip_bytes, double pace) {
  if (ceiling_) pace = std::min(pace, *ceiling_ / 8.0);
  const Duration needed = airtime(ip_bytes, pace);
  // After a rest, or when woken late: two packets at once, or 2 ms of them.
  const Duration allowance = std::max(kBurst, needed);
  const bool backlogged = now - ready_at_ <= allowance;
  ready_at_ =
      std::min(std::max(ready_at_, now - allowance) + needed, now + std::max(kAheadMax, needed));
  if (peer) charge(*peer, needed);
  return backlogged;
}

// The airtime is paid to the others in equal parts.
void NodePacer::charge(Peer peer, Duration airtime) {
  turn_ = peer;
  std::int64_t others = 0;
  for (const auto& [number, share] : shares_) others += share.wants && number != peer ? 1 : 0;
  if (others == 0) return;
  for (auto& [number, share] : shares_) {
    if (number == peer) {
      share.deficit = std::max(share.deficit - airtime, -kDeficitMax);
    } else if (share.wants) {
      share.deficit = std::min(share.deficit + airtime / others, kDeficitMax);
    }
  }
}

}  // namespace warren::mesh
