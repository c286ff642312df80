// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/layer/replica.hpp"
#include "tests/core/layer/random_codes.hpp"

namespace warren::test {

// What a broken program might do. The checker must notice each.
enum class Fault : std::uint8_t {
  kNone,
  kClaimsWhatIsNotHeld,
  kMissesAChange,
  kCodesNewerThanClaimed,
  kLowersHeld,
  kReusesRevision,
  kReusesLayerId,
};

struct FleetPlan {
  std::uint64_t seed = 0;
  Fault fault = Fault::kNone;
  std::uint32_t steps = 150;
  std::uint32_t keys = 200;      // intervals are cut among the lowest keys
  std::uint32_t blocks_max = 8;  // of the layer
  bool noise = false;            // blocks so full that packets are
  bool narrow = false;           // most packets claim few keys, and the origin keeps its disk
};

// One origin, replicas that get packets from it and from one another over a network that loses,
// doubles, delays and reorders them, and what the origin's layer was at each revision. After each
// step every block of every replica must be the origin's block at the revision held there.
class FleetModel {
 public:
  explicit FleetModel(const FleetPlan& plan);

  // Runs all steps; false as soon as a replica breaks the invariant.
  bool run();
  // Lets every replica catch up; the packets that took, or nothing if it takes too many or ends
  // with anything that differs from the origin.
  std::optional<std::size_t> catch_up();

  std::size_t intervals_seen_max() const { return intervals_seen_max_; }
  std::size_t regions_rested() const { return regions_rested_; }
  std::uint64_t count(ApplyResult result) const {
    return results_[static_cast<std::size_t>(result)];
  }

 private:
  using Row = std::vector<CodeBlock>;  // the layer at one revision, by place in blocks_

  bool step();
  void publish();
  void send();
  bool deliver();
  bool trouble();
  void restart(Replica& replica);
  void lose_origin_disk();
  void lose_last_tick();
  void lower_held(Replica& replica);

  std::vector<std::uint8_t> altered(const DiffPacket& packet);
  void add_needless_codes(BlockDiff& diff, Revision to);
  void forget_a_change(std::vector<BlockDiff>& diffs);

  bool exact(const Replica& replica) const;
  bool same_as_origin(const Replica& replica) const;
  KeyInterval random_keys();
  Replica& random_copy() { return nodes_[1 + below(random_, copies())]; }
  std::uint32_t copies() const { return static_cast<std::uint32_t>(nodes_.size()) - 1; }

  FleetPlan plan_;
  Random random_;
  std::vector<BlockOrdinal> blocks_;
  std::vector<Replica> nodes_;  // the first is the origin
  std::vector<Row> history_;    // by revision
  struct Flight {
    LayerId layer;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Flight> air_;
  std::size_t intervals_seen_max_ = 0;
  std::size_t regions_rested_ = 0;
  std::array<std::uint64_t, kApplyResults> results_{};
};

}  // namespace warren::test
