// SPDX-License-Identifier: Apache-2.0
#include "core/layer/replica.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <utility>

#include "core/voxel/bits.hpp"

namespace warren {
namespace {

VoxelMask places_that_differ(const BlockCodes& a, const BlockCodes& b) {
  VoxelMask differ{};
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    differ[cell] = (a.known[cell] ^ b.known[cell]) | (a.occupied[cell] ^ b.occupied[cell]) |
                   (a.stairs[cell] ^ b.stairs[cell]);
    for_each_bit(a.occupied[cell] & b.occupied[cell], [&](std::uint32_t bit) {
      const std::size_t place = cell << 6 | bit;
      if (a.costs[place] != b.costs[place]) differ[cell] |= std::uint64_t{1} << bit;
    });
  }
  return differ;
}

std::uint64_t count(const VoxelMask& mask) {
  std::uint64_t voxels = 0;
  for (const std::uint64_t cell : mask) voxels += static_cast<std::uint64_t>(std::popcount(cell));
  return voxels;
}

// Telling of a free voxel that did not change is allowed, and cheaper if it makes a whole 2x2x2
// cube or 4x4x4 cell uniform.
void fill_up_free(VoxelMask& told, const VoxelMask& free) {
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    if (told[cell] == 0) continue;
    if (free[cell] == kFullCell) told[cell] = kFullCell;
    for (int shift = 0; shift < 64; shift += 8) {
      const std::uint64_t cube = std::uint64_t{0xFF} << shift;
      if ((told[cell] & cube) != 0 && (free[cell] & cube) == cube) told[cell] |= cube;
    }
  }
}

// So is telling of all that is known where two thirds of it are to be told.
void fill_up_known(VoxelMask& told, const VoxelMask& known) {
  int to_tell = 0;
  int all = 0;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    to_tell += std::popcount(told[cell] & known[cell]);
    all += std::popcount(known[cell]);
  }
  if (3 * to_tell >= 2 * all) told = known;
}

void keep_only(BlockCodes& codes, const VoxelMask& told) {
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    for_each_bit(codes.occupied[cell] & ~told[cell],
                 [&](std::uint32_t bit) { codes.costs[cell << 6 | bit] = kNoCostData; });
    codes.known[cell] &= told[cell];
    codes.occupied[cell] &= told[cell];
    codes.stairs[cell] &= told[cell];
  }
}

BlockDiff diff_of(BlockOrdinal ordinal, const LayerBlock& block, Revision from) {
  BlockDiff diff{ordinal, block.history.latest(), false, block.codes.unpack()};
  VoxelMask told = block.history.changed_since(from);
  VoxelMask free{};
  std::uint64_t no_more_known = 0;
  for (std::size_t cell = 0; cell < kCellsPerBlock; ++cell) {
    free[cell] = diff.codes.known[cell] & ~diff.codes.occupied[cell];
    no_more_known |= told[cell] & ~diff.codes.known[cell];
  }
  // Only the whole block can say that a voxel is unknown.
  diff.replaces = no_more_known != 0;
  if (diff.replaces) return diff;
  fill_up_free(told, free);
  fill_up_known(told, diff.codes.known);
  keep_only(diff.codes, told);
  return diff;
}

// Of the keys after `below`, up to `highest`, the one that a header says in the fewest bytes.
BlockOrdinal roundest(BlockOrdinal below, BlockOrdinal highest) {
  const auto low_bits = static_cast<int>(std::bit_width(below ^ highest)) - 1;
  return highest >> low_bits << low_bits;
}

ApplyResult result_of(PacketError error) {
  return error == PacketError::kMalformed ? ApplyResult::kMalformed : ApplyResult::kUnknownVersion;
}

ApplyResult result_of(RaiseResult result) {
  switch (result) {
    case RaiseResult::kRaised:
      return ApplyResult::kApplied;
    case RaiseResult::kDuplicate:
      return ApplyResult::kDuplicate;
    case RaiseResult::kGap:
      return ApplyResult::kGap;
    case RaiseResult::kTooManyIntervals:
      break;
  }
  return ApplyResult::kTooManyIntervals;
}

}  // namespace

template <typename Change>
void Replica::change(BlockOrdinal ordinal, Change&& change) {
  wake(region_of(ordinal));
  blocks_.change(ordinal, [&](LayerBlock& block) {
    known_voxels_ -= count(block.codes.known());
    change(block);
    known_voxels_ += count(block.codes.known());
    digest_.update(ordinal, block.codes);
  });
}

Replica::Replica(const LayerId& id, Resolution resolution, const Holdings& holdings,
                 std::span<const StoredBlock> blocks)
    : id_(id), resolution_(resolution), holdings_(holdings) {
  for (const StoredBlock& stored : blocks) {
    assert(Revision{} < stored.changed_at && stored.changed_at <= holdings_.at(stored.block));
    change(stored.block, [&](LayerBlock& block) {
      block.codes = stored.codes;
      block.history.record_all(stored.changed_at);
    });
  }
}

std::vector<LayerDigest::Entry> Replica::digest_blocks(RegionOrdinal region) const {
  if (!blocks_.rests(region)) return digest_.blocks_of(region);
  std::vector<LayerDigest::Entry> entries;
  blocks_.for_each_changed(keys_of_region(region), {}, [&](BlockOrdinal block, const auto& found) {
    if (!found.codes.empty()) entries.push_back({block, hash_of(block, found.codes)});
    return true;
  });
  return entries;
}

std::size_t Replica::rest(Revision until, std::size_t most) {
  const std::vector<RegionOrdinal> resting = blocks_.rest(until, most);
  for (const RegionOrdinal region : resting) digest_.rest(region);
  return resting.size();
}

void Replica::wake(RegionOrdinal region) {
  if (!blocks_.rests(region)) return;
  digest_.wake(region, digest_blocks(region));
  blocks_.wake(region);
}

void Replica::tell_listener(std::span<const BlockOrdinal> changed) const {
  if (!listener_) return;
  for (const BlockOrdinal block : changed) listener_(block);
}

Revision Replica::publish(std::span<const CodedBlock> blocks) {
  assert(holdings_.intervals().size() == 1);
  const Revision now = holdings_.at(0);
  assert(now.number < std::numeric_limits<std::uint32_t>::max());
  const Revision next{now.number + 1};
  std::vector<BlockOrdinal> changed;
  for (const CodedBlock& published : blocks) {
    if (codes_in_place(published.block) == published.codes) continue;
    change(published.block, [&](LayerBlock& block) {
      const VoxelMask differ = places_that_differ(block.codes.unpack(), published.codes.unpack());
      block.codes = published.codes;
      block.history.record(next, differ);
    });
    changed.push_back(published.block);
  }
  if (changed.empty()) return now;
  holdings_ = Holdings(next);
  tell_listener(changed);
  return next;
}

std::optional<DiffPacket> Replica::encode(const EncodeRequest& request) const {
  KeyInterval keys = request.keys;
  while (!keys.empty() && holdings_.at(keys.first) <= request.from) {
    keys.first = holdings_.interval_around(keys.first).end;
  }
  if (keys.empty()) return std::nullopt;
  keys.end = std::min(keys.end, holdings_.interval_around(keys.first).end);

  const Claim claim{keys, request.from, holdings_.at(keys.first)};
  PacketWriter writer(claim, request.limit_bytes);
  BlockOrdinal last_told = keys.first;
  BlockOrdinal end = keys.end;
  blocks_.for_each_changed(keys, request.from, [&](BlockOrdinal ordinal, const LayerBlock& block) {
    if (!writer.add(diff_of(ordinal, block, request.from))) {
      end = roundest(last_told, ordinal);
      return false;
    }
    last_told = ordinal;
    return true;
  });
  return writer.finish(end);
}

ApplyResult Replica::apply(const LayerId& layer, std::span<const std::uint8_t> packet) {
  const ApplyResult result = judge_and_apply(layer, packet);
  ++apply_counts_[static_cast<std::size_t>(result)];
  return result;
}

ApplyResult Replica::judge_and_apply(const LayerId& layer, std::span<const std::uint8_t> packet) {
  if (layer != id_) return ApplyResult::kOtherLayer;
  const auto header = read_header(packet);
  if (!header) return result_of(header.error());
  const RaiseResult judged = holdings_.judge(header->claim);
  if (judged != RaiseResult::kRaised) return result_of(judged);
  const auto diffs = read_blocks(*header, packet);
  if (!diffs) return result_of(diffs.error());

  std::vector<BlockOrdinal> changed;
  for (const BlockDiff& diff : *diffs) {
    const Revision held = holdings_.at(diff.block);
    // A block that did not change since is the same already.
    const bool is_news = header->claim.from <= held && held < diff.changed_at;
    if (is_news && apply(diff)) changed.push_back(diff.block);
  }
  holdings_.raise(header->claim);
  tell_listener(changed);
  return ApplyResult::kApplied;
}

bool Replica::apply(const BlockDiff& diff) {
  bool changed = false;
  change(diff.block, [&](LayerBlock& block) {
    BlockCodes codes = diff.codes;
    if (diff.replaces) {
      block.history.record_all(diff.changed_at);
    } else {
      codes = block.codes.unpack();
      codes.overlay(diff.codes);
      block.history.record(diff.changed_at, diff.codes.known);
    }
    CodeBlock applied(codes);
    changed = block.codes != applied;
    block.codes = std::move(applied);
  });
  return changed;
}

bool Replica::forget(const KeyInterval& keys) {
  if (!holdings_.forget(keys)) return false;
  std::vector<BlockOrdinal> changed;
  blocks_.for_each_changed(keys, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    known_voxels_ -= count(found.codes.known());
    if (listener_ && !found.codes.empty()) changed.push_back(block);
    return true;
  });
  // What is left of the regions at either end must have its hashes.
  for (const BlockOrdinal bound : {keys.first, keys.end - 1}) {
    const KeyInterval region = keys_of_region(region_of(bound));
    if (region.first < keys.first || keys.end < region.end) wake(region_of(bound));
  }
  blocks_.erase(keys);
  digest_.erase(keys);
  tell_listener(changed);
  return true;
}

}  // namespace warren
