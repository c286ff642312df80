// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/layer/replica.hpp"
#include "daemon/replication/config.hpp"
#include "daemon/replication/map_message.hpp"
#include "daemon/replication/revision_clock.hpp"
#include "transport/mesh_time.hpp"

namespace warren::replication {

// A layer that this node holds. Invariant: what `stored` says of it survives a crash.
struct HeldLayer {
  LayerId id;
  Slot slot = 0;
  const Replica* own = nullptr;   // somebody else here writes it
  std::unique_ptr<Replica> copy;  // or the mesh does
  Holdings stored;
  MeshTime changed = MeshTime::min();  // when its holdings changed last
  std::uint64_t version = 0;           // counts these changes
  RevisionClock times;
  std::set<BlockOrdinal> not_batched;  // blocks of a copy changed since the last batch
  std::vector<KeyInterval> forgotten;  // of a copy, since the last batch
  Revision batched;                    // of an own layer
  bool full = false;                   // the copy needs more room than it gets

  const Replica& replica() const { return own != nullptr ? *own : *copy; }
  Revision highest() const { return replica().holdings().highest({}); }
  // No revision leaves the node that a crash might make it write again.
  bool may_be_told() const { return own == nullptr || stored == own->holdings(); }
};

// What the store has to write in one transaction.
struct StoredLayer {
  LayerId id;
  Resolution resolution;
  bool own = false;
  LayerPose pose;
  Holdings holdings;
  std::vector<KeyInterval> forgotten;  // emptied before the blocks are put
  std::vector<StoredBlock> blocks;
};

enum class Admission : std::uint8_t { kKnown, kAdmitted, kOwnLayer, kOtherResolution, kFull };

// Why a packet for a copy was not applied, beyond what its replica says.
enum class Refusal : std::uint8_t { kOwnLayer, kNoRoom };

// The layers this node holds: its own, which are only read here, and copies. At most so many, with
// some room that only own ones get; each copy with at most so many regions, and all copies in so
// much memory: a member may claim anything.
class LayerBook {
 public:
  explicit LayerBook(const LayerLimits& limits) : limits_(limits) {
    limits_.layers_max = std::min<std::size_t>(limits_.layers_max, kSlotsMax);
  }

  // The replica must outlive this. False: no room, or held already. What it holds now is stored.
  bool add_own(const Replica& layer);
  // A copy as the store had it.
  bool restore(std::unique_ptr<Replica> copy);
  // Makes an empty copy if the layer is new.
  Admission admit(const LayerId& id, Resolution resolution);
  void on_published(MeshTime now, const LayerId& id);

  struct Applied {
    ApplyResult result = ApplyResult::kMalformed;
    std::optional<Refusal> refused;  // then the result means nothing
    std::optional<Claim> claim;      // what the packet claims, if that could be read
  };
  Applied apply(MeshTime now, HeldLayer& layer, std::span<const std::uint8_t> packet);
  // Forgets these keys of a copy; false if its holdings do not bear it.
  bool forget(MeshTime now, HeldLayer& layer, const KeyInterval& keys);

  // Copies that stopped for want of memory go on when others have been laid to rest since.
  void review_room(MeshTime now);

  HeldLayer* find(const LayerId& id);
  const HeldLayer* find(const LayerId& id) const;
  HeldLayer* at(Slot slot) { return slot < layers_.size() ? layers_[slot].get() : nullptr; }
  // In the order of slots.
  const std::vector<std::unique_ptr<HeldLayer>>& layers() const { return layers_; }

  // What is not stored yet, and what stands for it in on_stored(). Batches are stored in order.
  bool has_unstored() const;
  std::vector<StoredLayer> take_batch(std::uint64_t batch);
  // Everything up to this batch is stored; returns the layers that this moves on.
  std::vector<HeldLayer*> on_stored(std::uint64_t batch);
  // Nothing of this batch is stored: the next one says the whole of its layers again.
  void on_refused(std::uint64_t batch);

  std::size_t memory_bytes() const;
  // Layers that were not admitted for want of room, and packets refused.
  std::uint64_t layers_refused() const { return layers_refused_; }
  std::uint64_t refused(Refusal reason) const { return refused_[static_cast<std::size_t>(reason)]; }
  const std::array<std::uint64_t, kApplyResults>& apply_counts() const { return apply_counts_; }

 private:
  struct Batched {
    std::uint64_t batch = 0;
    LayerId layer;
    Holdings holdings;
  };
  HeldLayer& insert(const LayerId& id);
  static void note_change(MeshTime now, HeldLayer& layer);
  bool is_behind_store(const HeldLayer& layer) const;
  void note_touched(HeldLayer& layer, const KeyInterval& keys, Revision from);
  Applied refuse(Refusal reason);
  bool is_out_of_memory();

  LayerLimits limits_;
  std::vector<std::unique_ptr<HeldLayer>> layers_;
  std::map<LayerId, HeldLayer*> by_id_;
  std::deque<Batched> batched_;
  std::size_t restored_bytes_ = 0;  // of copies
  bool out_of_memory_ = false;
  std::uint32_t applied_ = 0;  // packets since memory was looked at
  MeshTime reviewed_ = MeshTime::min();
  std::uint64_t layers_refused_ = 0;
  std::array<std::uint64_t, 2> refused_{};
  std::array<std::uint64_t, kApplyResults> apply_counts_{};
};

}  // namespace warren::replication
