// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "core/layer/merge_map.hpp"
#include "core/layer/replica.hpp"
#include "daemon/fleet/block_runs.hpp"

namespace warren {

// A map whose changes are numbered, as those read it who keep a copy.
class BlockFeed {
 public:
  virtual ~BlockFeed() = default;

  // Number of the last change.
  virtual std::uint64_t now() const = 0;
  // Whether it can still tell all that changed after `since`; 0: since it was empty.
  virtual bool remembers(std::uint64_t since) const = 0;
  // Calls visit(block) in key order for at least all blocks in the box, from `first` on, that
  // changed after `since`, as long as it returns true. `visit` may not read.
  using Visitor = std::function<bool(BlockOrdinal)>;
  virtual void for_each_changed(std::uint64_t since, const BlockBox& box, BlockOrdinal first,
                                const Visitor& visit) const = 0;
  virtual BlockVoxels read(BlockOrdinal block) = 0;
};

// Its numbers are the merge-map's own.
class MergeFeed : public BlockFeed {
 public:
  // Keeps a reference; reading derives blocks.
  explicit MergeFeed(MergeMap& map) : map_(map) {}

  std::uint64_t now() const override { return map_.cursor(); }
  bool remembers(std::uint64_t since) const override { return map_.remembers(since); }
  void for_each_changed(std::uint64_t since, const BlockBox& box, BlockOrdinal first,
                        const Visitor& visit) const override;
  BlockVoxels read(BlockOrdinal block) override { return map_.codes(block_key_of(block)); }

 private:
  MergeMap& map_;
};

// A layer that this node writes. Its numbers are revisions; it forgets nothing.
class LayerFeed : public BlockFeed {
 public:
  // Keeps a reference.
  explicit LayerFeed(const Replica& layer) : layer_(layer) {}

  std::uint64_t now() const override { return layer_.holdings().at(0).number; }
  bool remembers(std::uint64_t) const override { return true; }
  void for_each_changed(std::uint64_t since, const BlockBox& box, BlockOrdinal first,
                        const Visitor& visit) const override;
  BlockVoxels read(BlockOrdinal block) override;

 private:
  const Replica& layer_;
};

}  // namespace warren
