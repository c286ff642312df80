// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/layer/coded_block.hpp"
#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// The codes of one block of a self-map.
CodeBlock codes_of(const SelfMap& map, const BlockKey& key);

// What the owner of a self-map hands over at a tick: the blocks that changed after the scan
// numbered `cursor`, in no particular order, no block twice.
std::vector<CodedBlock> blocks_changed_since(const SelfMap& map, std::uint32_t cursor);

// What may wait because it costs many bits and tells a planner little. Neither ever makes a
// published voxel wrong: it is the exact one, or one that is still unknown though it is free, or a
// cost one bin off on the same side of the planner's thresholds.
struct SenderRules {
  // A free voxel that is new waits until its 2x2x2 cube is known. Occupied ones never wait, nor do
  // those that are free again.
  bool hold_ragged_free = true;
  // A cost waits until it is two bins off, crosses a threshold, or loses or gains its data. Stairs
  // never wait.
  bool hold_small_cost_changes = true;
};

// Decides what of the exact codes the origin's layer shows. What it hands out goes to the layer's
// publish(); it keeps the exact codes of the blocks that hold something back.
class Publisher {
 public:
  explicit Publisher(const SenderRules& rules = {}) : rules_(rules) {}

  // `now` has the exact codes of every block that changed since the tick before, none twice.
  std::vector<CodedBlock> tick(std::span<const CodedBlock> now, const Replica& published);
  // All that is held back: with it the layer is exact.
  std::vector<CodedBlock> flush(const Replica& published);
  std::size_t blocks_held_back() const { return held_back_.size(); }
  std::size_t memory_bytes() const;

 private:
  SenderRules rules_;
  std::map<BlockOrdinal, CodeBlock> held_back_;
};

}  // namespace warren
