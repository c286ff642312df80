// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/blocks_answer.hpp"

#include <algorithm>
#include <cmath>

namespace warren {
namespace {

constexpr std::int32_t kBlockMin = kKeyMin / kBlockEdge;
constexpr std::int32_t kBlockMax = (kKeyMax + 1) / kBlockEdge - 1;
constexpr std::size_t kKeyBytesMax = 9;  // three numbers of 14 bits as protobuf packs them
// A corner on a block's border may be a rounding off.
constexpr double kCornerSlack_m = 1e-9;

bool is_unknown(const BlockVoxels& voxels) {
  return std::all_of(voxels.begin(), voxels.end(),
                     [](VoxelCode code) { return code == VoxelCode{}; });
}

bool goes_on(const BlockFeed& feed, std::uint64_t frame, const BlocksCursor& cursor) {
  return cursor.frame == frame && cursor.until <= feed.now() && feed.remembers(cursor.since);
}

void begin_sweep(BlocksCursor& cursor, const BlockFeed& feed) {
  cursor.until = feed.now();
  cursor.next = 0;
}

// Some blocks from `first` on, and where to go on after them.
struct Lot {
  std::vector<BlockOrdinal> blocks;
  BlockOrdinal next = kOrdinalEnd;
};
Lot next_lot(const BlockFeed& feed, const BlocksCursor& cursor, const BlockBox& box) {
  Lot lot;
  feed.for_each_changed(cursor.since, box, cursor.next, [&](BlockOrdinal block) {
    if (lot.blocks.size() == BlocksAnswer::kBlocksMax) {
      lot.next = block;
      return false;
    }
    lot.blocks.push_back(block);
    return true;
  });
  return lot;
}

struct Telling {
  bool to_empty_copy = false;
  std::size_t most_bytes = 0;
};
// Where to go on: the lot's end, or before it if the answer is full.
BlockOrdinal tell_lot(BlockFeed& feed, const Lot& lot, const Telling& telling,
                      BlocksAnswer& answer) {
  for (const BlockOrdinal block : lot.blocks) {
    const std::size_t bytes = answer.codes.size() + answer.keys.size() * kKeyBytesMax;
    if (bytes + kBlockRunsMax + kKeyBytesMax > telling.most_bytes) return block;
    const BlockVoxels voxels = feed.read(block);
    // Who has nothing need not be told that there is nothing.
    if (telling.to_empty_copy && is_unknown(voxels)) continue;
    answer.keys.push_back(block_key_of(block));
    append_runs(voxels, answer.codes);
  }
  return lot.next;
}

}  // namespace

BlockBox blocks_in(const std::optional<MapBox>& box, double resolution_m,
                   const Eigen::Vector3d& origin_map) {
  const BlockKey lowest{kBlockMin, kBlockMin, kBlockMin};
  const BlockKey highest{kBlockMax, kBlockMax, kBlockMax};
  if (!box) return {lowest, highest};
  const double edge_m = resolution_m * kBlockEdge;
  // One past the key space at either end is enough to be outside.
  const auto block_at = [&](double place_m) {
    const double block = std::clamp(std::floor(place_m / edge_m), kBlockMin - 1.0, kBlockMax + 1.0);
    return static_cast<std::int32_t>(block);
  };
  const Eigen::Vector3d low = box->low - origin_map - Eigen::Vector3d::Constant(kCornerSlack_m);
  const Eigen::Vector3d high = box->high - origin_map + Eigen::Vector3d::Constant(kCornerSlack_m);
  const auto from = [&](double place_m) { return std::max(block_at(place_m), kBlockMin); };
  const auto to = [&](double place_m) { return std::min(block_at(place_m), kBlockMax); };
  return {{from(low.x()), from(low.y()), from(low.z())},
          {to(high.x()), to(high.y()), to(high.z())}};
}

void tell_blocks(BlockFeed& feed, std::uint64_t frame, const BlockBox& box,
                 const BlocksQuestion& question, BlocksAnswer& answer) {
  answer.anew = !question.cursor || !goes_on(feed, frame, *question.cursor);
  BlocksCursor cursor;
  if (!answer.anew) cursor = *question.cursor;
  cursor.scope = question.scope();
  cursor.frame = frame;
  // Since this sweep began, in an earlier answer, more may have changed where it has been.
  const bool is_late = !cursor.is_through() && cursor.next != 0;
  if (cursor.is_through()) begin_sweep(cursor, feed);
  const Lot lot = next_lot(feed, cursor, box);
  cursor.next = tell_lot(feed, lot, {cursor.since == 0, question.most_bytes}, answer);
  if (cursor.is_through()) cursor.since = cursor.until;
  if (cursor.is_through() && is_late && cursor.since < feed.now()) begin_sweep(cursor, feed);
  answer.cursor = cursor;
}

}  // namespace warren
