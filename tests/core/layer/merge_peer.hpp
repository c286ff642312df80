// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/merge_map.hpp"
#include "core/layer/replica.hpp"

namespace warren::test {

// One who knows a layer of somebody else by packets alone, and merges it.
class MergePeer {
 public:
  MergePeer(const LayerId& id, double resolution_m)
      : replica_(std::make_unique<Replica>(id, *Resolution::from_metres(resolution_m))),
        map_({resolution_m}) {
    REQUIRE(map_.add_layer(id, *replica_, resolution_m, Eigen::Isometry3d::Identity()) ==
            MergeResult::kDone);
  }

  // Gets all that it lacks.
  void catch_up(const Replica& origin) {
    const Revision held = replica_->holdings().at(0);
    KeyInterval keys;
    while (const auto packet = origin.encode({keys, held})) {
      keys.first = packet->claim.keys.end;
      REQUIRE(replica_->apply(origin.id(), packet->bytes) == ApplyResult::kApplied);
    }
    replica_->for_each_changed({}, held, [&](BlockOrdinal block, const LayerBlock&) {
      REQUIRE(map_.block_changed(origin.id(), block) == MergeResult::kDone);
      return true;
    });
  }

  const Replica& replica() const { return *replica_; }
  MergeMap& map() { return map_; }

 private:
  std::unique_ptr<Replica> replica_;
  MergeMap map_;
};

}  // namespace warren::test
