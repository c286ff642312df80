// SPDX-License-Identifier: Apache-2.0
#include "tests/core/layer/fleet_model.hpp"

#include <algorithm>
#include <utility>

namespace warren::test {
namespace {

constexpr std::size_t kFlightsMax = 30;

std::vector<StoredBlock> stored(const Replica& replica) {
  std::vector<StoredBlock> blocks;
  replica.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& found) {
    blocks.push_back({block, found.history.latest(), found.codes});
    return true;
  });
  return blocks;
}

std::vector<std::uint8_t> written(const Claim& claim, const std::vector<BlockDiff>& diffs) {
  PacketWriter writer(claim, std::size_t{64} * 1024);
  for (const BlockDiff& diff : diffs) writer.add(diff);
  return writer.finish(claim.keys.end).bytes;
}

}  // namespace

FleetModel::FleetModel(const FleetPlan& plan) : plan_(plan), random_(plan.seed) {
  const std::uint32_t blocks = 2 + below(random_, plan_.blocks_max - 1);
  while (blocks_.size() < blocks) {
    blocks_.push_back(below(random_, plan_.keys));
    if (chance(random_, 10)) blocks_.back() = kOrdinalEnd - 1 - below(random_, 3);
    std::sort(blocks_.begin(), blocks_.end());
    blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
  }
  for (std::uint32_t count = 2 + below(random_, 4); count > 0; --count) {
    nodes_.emplace_back(LayerId{1, 1, plan_.seed}, kDefaultResolution);
  }
  history_.emplace_back(blocks_.size());
}

bool FleetModel::run() {
  for (std::uint32_t i = 0; i < plan_.steps; ++i) {
    if (!step()) return false;
  }
  return true;
}

bool FleetModel::step() {
  const std::uint32_t dice = below(random_, 1000);
  if (dice < 150) {
    publish();
    return exact(nodes_[0]);
  }
  if (dice < 600) {
    send();
    return true;
  }
  return dice < 950 ? deliver() : trouble();
}

void FleetModel::publish() {
  Row row = history_.back();
  std::vector<CodedBlock> changes;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (chance(random_, 60)) continue;
    BlockCodes codes = row[i].unpack();
    if (chance(random_, 3)) codes = {};
    if (plan_.noise && chance(random_, 30)) codes = random_codes(random_);
    for (std::uint32_t changes_left = below(random_, 6); changes_left > 0; --changes_left) {
      const std::uint32_t place = below(random_, chance(random_, 50) ? 8 : kVoxelsPerBlock);
      codes.set(place, random_code(random_));
    }
    row[i] = CodeBlock(codes);
    changes.push_back({blocks_[i], row[i]});
  }
  const Revision revision = nodes_[0].publish(changes);
  history_.resize(revision.number + std::size_t{1});
  history_.back() = std::move(row);
}

void FleetModel::send() {
  const Replica& sender = nodes_[below(random_, copies() + 1)];
  const KeyInterval keys = random_keys();
  const Replica& receiver = nodes_[below(random_, copies() + 1)];
  const Revision from = chance(random_, 50)
                            ? receiver.holdings().lowest(keys)
                            : Revision{below(random_, sender.holdings().at(keys.first).number + 1)};
  const auto packet = sender.encode({keys, from, kPacketBytesMin + below(random_, 961)});
  if (!packet) return;
  if (air_.size() == kFlightsMax) air_.erase(air_.begin() + below(random_, kFlightsMax));
  air_.push_back({sender.id(), altered(*packet)});
}

bool FleetModel::deliver() {
  if (air_.empty()) return true;
  const std::uint32_t index = below(random_, static_cast<std::uint32_t>(air_.size()));
  Replica& receiver = random_copy();
  const ApplyResult result = receiver.apply(air_[index].layer, air_[index].bytes);
  ++results_[static_cast<std::size_t>(result)];
  if (chance(random_, 60)) air_.erase(air_.begin() + index);
  intervals_seen_max_ = std::max(intervals_seen_max_, receiver.holdings().intervals().size());
  return exact(receiver);
}

bool FleetModel::trouble() {
  Replica& copy = random_copy();
  const std::uint32_t dice = below(random_, 100);
  if (dice < 40) {
    if (plan_.fault == Fault::kLowersHeld) lower_held(copy);
    copy.forget(random_keys());
  } else if (dice < 60) {
    restart(chance(random_, 20) ? nodes_[0] : copy);
  } else if (dice < 80) {
    Replica& node = nodes_[below(random_, copies() + 1)];
    const Revision until{below(random_, node.holdings().highest({}).number + 1)};
    if (chance(random_, 50)) {
      node.drop_history(until);
    } else {
      regions_rested_ += node.rest(until, 1 + below(random_, 20));
    }
  } else if (dice < 88) {
    copy = Replica(nodes_[0].id(), kDefaultResolution);
  } else if (dice < 92 && !plan_.narrow) {
    lose_origin_disk();
  } else if (plan_.fault == Fault::kReusesRevision) {
    lose_last_tick();
  }
  return std::all_of(nodes_.begin(), nodes_.end(), [&](const Replica& r) { return exact(r); });
}

void FleetModel::restart(Replica& replica) {
  replica = Replica(replica.id(), replica.resolution(), replica.holdings(), stored(replica));
}

void FleetModel::lose_origin_disk() {
  LayerId id = nodes_[0].id();
  if (plan_.fault != Fault::kReusesLayerId) {
    ++id.incarnation;
    for (Replica& node : nodes_) node = Replica(id, kDefaultResolution);
  }
  nodes_[0] = Replica(id, kDefaultResolution);
  history_.assign(1, Row(blocks_.size()));
  publish();
}

void FleetModel::lose_last_tick() {
  if (history_.size() < 2) return;
  history_.pop_back();
  std::vector<StoredBlock> blocks;
  const Revision last{static_cast<std::uint32_t>(history_.size()) - 1};
  for (std::size_t i = 0; i < blocks_.size() && last.number > 0; ++i) {
    blocks.push_back({blocks_[i], last, history_.back()[i]});
  }
  nodes_[0] = Replica(nodes_[0].id(), nodes_[0].resolution(), Holdings(last), blocks);
  publish();
}

void FleetModel::lower_held(Replica& replica) {
  const Revision held = replica.holdings().lowest({});
  if (held.number < 2) return;
  const Revision lowered{1 + below(random_, held.number - 1)};
  std::vector<StoredBlock> blocks = stored(replica);
  for (StoredBlock& block : blocks) block.changed_at = std::min(block.changed_at, lowered);
  replica = Replica(replica.id(), replica.resolution(), Holdings(lowered), blocks);
}

// Plants the fault, or what is allowed: a mask that holds more than needed.
std::vector<std::uint8_t> FleetModel::altered(const DiffPacket& packet) {
  const bool allowed = plan_.fault == Fault::kNone && chance(random_, 20);
  const bool forged = plan_.fault != Fault::kNone && chance(random_, 10);
  if (!allowed && !forged) return packet.bytes;
  Claim claim = packet.claim;
  auto diffs = *read_blocks(*read_header(packet.bytes), packet.bytes);
  switch (plan_.fault) {
    case Fault::kNone:
      for (BlockDiff& diff : diffs) add_needless_codes(diff, claim.to);
      break;
    case Fault::kClaimsWhatIsNotHeld:
      ++claim.to.number;
      break;
    case Fault::kMissesAChange:
      forget_a_change(diffs);
      break;
    case Fault::kCodesNewerThanClaimed:
      if (claim.to.number - claim.from.number < 2) return packet.bytes;
      --claim.to.number;
      for (BlockDiff& diff : diffs) diff.changed_at = std::min(diff.changed_at, claim.to);
      break;
    default:
      return packet.bytes;
  }
  return written(claim, diffs);
}

void FleetModel::add_needless_codes(BlockDiff& diff, Revision to) {
  const auto place = std::lower_bound(blocks_.begin(), blocks_.end(), diff.block);
  const CodeBlock& block = history_[to.number][static_cast<std::size_t>(place - blocks_.begin())];
  block.for_each_known([&](std::uint32_t voxel, VoxelCode code) {
    if (chance(random_, 30)) diff.codes.set(voxel, code);
  });
}

void FleetModel::forget_a_change(std::vector<BlockDiff>& diffs) {
  if (diffs.empty()) return;
  BlockDiff& diff = diffs[below(random_, static_cast<std::uint32_t>(diffs.size()))];
  std::vector<std::uint32_t> told;
  CodeBlock(diff.codes).for_each_known([&](std::uint32_t voxel, VoxelCode) {
    told.push_back(voxel);
  });
  if (told.empty()) return;
  diff.codes.set(told[below(random_, static_cast<std::uint32_t>(told.size()))], VoxelCode{});
}

bool FleetModel::exact(const Replica& replica) const {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const std::size_t held = replica.holdings().at(blocks_[i]).number;
    const LayerBlock* const found = replica.find(blocks_[i]);
    if (held >= history_.size()) return false;
    if (found != nullptr ? found->codes != history_[held][i] : !history_[held][i].empty()) {
      return false;
    }
  }
  return true;
}

bool FleetModel::same_as_origin(const Replica& replica) const {
  return replica.holdings() == nodes_[0].holdings() && exact(replica) &&
         replica.digest().root() == nodes_[0].digest().root();
}

std::optional<std::size_t> FleetModel::catch_up() {
  const Revision latest = nodes_[0].holdings().at(0);
  std::size_t packets = 0;
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    // Whoever has caught up serves the next.
    const Replica& sender = nodes_[chance(random_, 50) ? i - 1 : 0];
    const std::size_t packets_max =
        packets + 2 * (nodes_[i].holdings().intervals().size() + blocks_.size());
    while (const auto first = nodes_[i].holdings().first_below(latest)) {
      if (++packets > packets_max) return std::nullopt;
      const Revision from = nodes_[i].holdings().at(*first);
      const auto packet = sender.encode({{*first, kOrdinalEnd}, from, kPacketBytesMin});
      if (!packet || packet->claim.keys.first != *first) return std::nullopt;
      if (nodes_[i].apply(sender.id(), packet->bytes) != ApplyResult::kApplied) return std::nullopt;
      if (!exact(nodes_[i])) return std::nullopt;
    }
    if (!same_as_origin(nodes_[i])) return std::nullopt;
  }
  return packets;
}

KeyInterval FleetModel::random_keys() {
  const std::uint32_t first = chance(random_, 5) ? 0 : below(random_, plan_.keys);
  const bool wide = chance(random_, plan_.narrow ? 1 : 50);
  const std::uint32_t longest = wide ? plan_.keys : 1 + plan_.keys / 50;
  const std::uint32_t end = first + 1 + below(random_, longest);
  return {first, end >= plan_.keys ? kOrdinalEnd : BlockOrdinal{end}};
}

}  // namespace warren::test
