// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/replication/digest_walk.hpp"
#include "daemon/replication/node_state.hpp"
#include "daemon/replication/pulling.hpp"

namespace warren::replication {

// What another member has of a layer that we hold, as far as it is known here: by what it said and
// by what we delivered.
struct PeerLag {
  MemberId member;
  Revision has_all_up_to;
  std::uint32_t lag_revisions = 0;
  std::uint64_t lag_voxels = 0;      // changed since, at least
  Duration behind{};                 // since when there is something that it lacks
  std::optional<bool> digest_equal;  // nothing: it did not say, or of another revision
};

struct LayerReport {
  LayerId id;
  bool own = false;
  Revision has_all_up_to;
  Revision highest;
  std::optional<MemberId> provider;
  Hops hops = kNoWay;
  bool full = false;  // of a copy that needs more room than it gets
  WalkCounts digests;
  std::vector<PeerLag> peers;
};

// One for each layer, in the order in which they came.
std::vector<LayerReport> report(const NodeState& node, const Pulling& pulling,
                                const DigestWalk& walk);

}  // namespace warren::replication
