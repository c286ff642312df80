// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/layer/coded_block.hpp"
#include "core/layer/diff_packet.hpp"
#include "core/layer/digest.hpp"
#include "core/layer/holdings.hpp"
#include "core/layer/layer_blocks.hpp"
#include "core/layer/layer_pose.hpp"
#include "core/layer/resolution.hpp"

namespace warren {

enum class ApplyResult : std::uint8_t {
  kApplied,    // at least a part of what is claimed was news
  kDuplicate,  // all of it is held already
  kGap,        // it begins after what is held
  kTooManyIntervals,
  kMalformed,
  kUnknownVersion,
  kOtherLayer,
};
inline constexpr std::size_t kApplyResults = 7;

// A block as a store keeps it.
struct StoredBlock {
  BlockOrdinal block = 0;
  Revision changed_at;
  CodeBlock codes;
};

struct EncodeRequest {
  KeyInterval keys;
  Revision from;                   // what the receivers hold there
  std::size_t limit_bytes = 1200;  // per packet, at least kPacketBytesMin
};

// A layer: the one that its origin writes, or a copy of it. Invariant: every block is exactly the
// origin's as of the revision held there. Only publish() makes revisions, and only the origin may
// call it; copies change by packets, which arrive in any order, twice or never.
class Replica {
 public:
  Replica(const LayerId& id, Resolution resolution) : id_(id), resolution_(resolution) {}
  // As it was stored. What changed when within a block is forgotten.
  Replica(const LayerId& id, Resolution resolution, const Holdings& holdings,
          std::span<const StoredBlock> blocks);

  const LayerId& id() const { return id_; }
  Resolution resolution() const { return resolution_; }
  LayerPose& pose() { return pose_; }
  const LayerPose& pose() const { return pose_; }
  const Holdings& holdings() const { return holdings_; }
  std::uint64_t known_voxels() const { return known_voxels_; }
  // Its root and regions; for their blocks ask digest_blocks().
  const LayerDigest& digest() const { return digest_; }
  std::vector<LayerDigest::Entry> digest_blocks(RegionOrdinal region) const;
  // Null if nothing was ever known of it. Valid until the next call of any function here.
  const LayerBlock* find(BlockOrdinal block) const { return blocks_.find(block); }
  // The block's codes, empty if nothing is known of it: a copy, or valid as what find() gives.
  CodeBlock codes(BlockOrdinal block) const { return codes_in_place(block); }
  const CodeBlock& codes_in_place(BlockOrdinal block) const {
    static const CodeBlock kEmpty;
    const LayerBlock* const found = find(block);
    return found != nullptr ? found->codes : kEmpty;
  }
  // Calls visit(BlockOrdinal, const LayerBlock&) in key order for the blocks changed after `from`,
  // as long as it returns true; emptied ones are among them. `visit` may read this replica.
  template <typename Visit>
  void for_each_changed(const KeyInterval& keys, Revision from, Visit&& visit) const {
    blocks_.for_each_changed(keys, from, visit);
  }

  // The regions of 8x8x8 blocks changed after `from`, latest first, at most `most` of them: where a
  // catch-up begins.
  std::vector<KeyInterval> regions_by_change(Revision from, std::size_t most) const {
    return blocks_.regions_by_change(from, most);
  }

  // Makes the next revision, in which these blocks have these codes, and returns it. The revision
  // stays if no code differs. Preconditions: the whole layer is held at one revision, and no block
  // comes twice.
  Revision publish(std::span<const CodedBlock> blocks);

  // The first packet of what receivers lack who hold `from`: its claim begins at the first key of
  // the request where more than `from` is held, and the next request at the claim's end. Nothing
  // when there is nothing to tell.
  std::optional<DiffPacket> encode(const EncodeRequest& request) const;

  // Takes from a packet whatever is news here; all or nothing of it. Never trusts it.
  ApplyResult apply(const LayerId& layer, std::span<const std::uint8_t> packet);
  // How often apply() returned each result.
  const std::array<std::uint64_t, kApplyResults>& apply_counts() const { return apply_counts_; }

  // Empties these blocks and holds nothing there; false if that made too many intervals.
  bool forget(const KeyInterval& keys);
  // Gives back memory: blocks unchanged since `until` will be told as a whole to who lacks them.
  void drop_history(Revision until) { blocks_.drop_history(until); }
  // Packs the blocks of regions unchanged since `until`, of at most `most` regions, longest
  // unchanged first; how many it did. They can be read, told and changed as before, at the price of
  // unpacking, and their history is dropped. A region takes some milliseconds.
  std::size_t rest(Revision until, std::size_t most);

  // Called after publish(), apply() or forget() have changed the codes of a block, with the whole
  // change done. It may read this replica.
  void on_change(std::function<void(BlockOrdinal)> listener) { listener_ = std::move(listener); }

  std::size_t regions() const { return blocks_.regions(); }
  std::size_t regions_awake() const { return blocks_.regions_awake(); }
  // Of memory_bytes(), the packed blocks of regions at rest.
  std::size_t bytes_at_rest() const { return blocks_.bytes_at_rest(); }
  std::size_t memory_bytes() const { return blocks_.memory_bytes() + digest_.memory_bytes(); }

 private:
  ApplyResult judge_and_apply(const LayerId& layer, std::span<const std::uint8_t> packet);
  // Whether codes changed.
  bool apply(const BlockDiff& diff);
  template <typename Change>
  void change(BlockOrdinal block, Change&& change);
  void wake(RegionOrdinal region);
  void tell_listener(std::span<const BlockOrdinal> changed) const;

  LayerId id_;
  Resolution resolution_;
  LayerPose pose_;
  Holdings holdings_;
  LayerBlocks blocks_;
  LayerDigest digest_;
  std::uint64_t known_voxels_ = 0;
  std::array<std::uint64_t, kApplyResults> apply_counts_{};
  std::function<void(BlockOrdinal)> listener_;
};

// Calls visit(DiffPacket&) for all packets of a request in key order, as long as it returns true.
template <typename Visit>
void for_each_packet(const Replica& sender, EncodeRequest request, Visit&& visit) {
  while (auto packet = sender.encode(request)) {
    request.keys.first = packet->claim.keys.end;
    if (!visit(*packet)) return;
  }
}

}  // namespace warren
