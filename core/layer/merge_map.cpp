// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_map.hpp"

#include <cassert>
#include <utility>

namespace warren {
namespace {

MergeSourceId self_id(std::uint32_t number) { return {true, LayerId{0, number, 0}}; }
MergeSourceId foreign_id(const LayerId& id) { return {false, id}; }

}  // namespace

MergeMap::MergeMap(const MergeConfig& config)
    : config_(config), lattice_(config.resolution_m), cache_(config.cached_blocks) {
  assert(config.resolution_m > 0.0);
  sources_.push_back(nullptr);  // kNoSource
}

MergeResult MergeMap::open_self_layer(std::uint32_t number,
                                      const Eigen::Isometry3d& T_merge_layer) {
  const auto placement = place(T_merge_layer, config_.resolution_m);
  if (!placement) return MergeResult::kBadPose;
  return add(std::make_unique<MergeSource>(number, config_.resolution_m, *placement));
}

MergeResult MergeMap::update_self(std::uint32_t number, std::span<const CodedBlock> blocks) {
  MergeSource* const source = find(self_id(number));
  if (source == nullptr) return MergeResult::kUnknownLayer;
  begin_change();
  for (const CodedBlock& block : blocks) {
    const bool differs = source->keep(block);
    if (differs && source->counts()) update_block(*source, block.block);
  }
  return MergeResult::kDone;
}

MergeResult MergeMap::move_self_layer(std::uint32_t number,
                                      const Eigen::Isometry3d& T_merge_layer) {
  return move(self_id(number), T_merge_layer);
}

MergeResult MergeMap::add_layer(const LayerId& id, const Replica& replica, double resolution_m,
                                const Eigen::Isometry3d& T_merge_layer) {
  if (!MergePlacement::is_resolution_near(resolution_m, config_.resolution_m)) {
    return MergeResult::kBadResolution;
  }
  const auto placement = place(T_merge_layer, resolution_m);
  if (!placement) return MergeResult::kBadPose;
  return add(std::make_unique<MergeSource>(id, replica, resolution_m, *placement));
}

MergeResult MergeMap::block_changed(const LayerId& id, BlockOrdinal block) {
  MergeSource* const source = find(foreign_id(id));
  if (source == nullptr) return MergeResult::kUnknownLayer;
  if (!source->counts()) return MergeResult::kDone;
  begin_change();
  update_block(*source, block);
  return MergeResult::kDone;
}

MergeResult MergeMap::note_time(const LayerId& id, Revision revision, std::int64_t fleet_time_ns) {
  MergeSource* const source = find(foreign_id(id));
  if (source == nullptr) return MergeResult::kUnknownLayer;
  const Revision from = source->times().note(revision, fleet_time_ns);
  if (config_.rule != MergeRule::kNewest || !source->counts()) return MergeResult::kDone;
  begin_change();
  source->for_each_changed(from, [&](BlockOrdinal block) {
    if (source->known_blocks().contains(block)) mark_changed(*source, block);
  });
  return MergeResult::kDone;
}

MergeResult MergeMap::move_layer(const LayerId& id, const Eigen::Isometry3d& T_merge_layer) {
  return move(foreign_id(id), T_merge_layer);
}

MergeResult MergeMap::retract_layer(const LayerId& id) { return retract(foreign_id(id)); }
MergeResult MergeMap::retract_self_layer(std::uint32_t number) { return retract(self_id(number)); }
MergeResult MergeMap::restore_layer(const LayerId& id) { return restore(foreign_id(id)); }
MergeResult MergeMap::restore_self_layer(std::uint32_t number) { return restore(self_id(number)); }

MergeResult MergeMap::retract(const MergeSourceId& id) {
  MergeSource* const source = find(id);
  if (source == nullptr) return MergeResult::kUnknownLayer;
  untouch_all(*source);
  source->set_counts(false);
  forget_untouched_regions();
  return MergeResult::kDone;
}

MergeResult MergeMap::restore(const MergeSourceId& id) {
  MergeSource* const source = find(id);
  if (source == nullptr) return MergeResult::kUnknownLayer;
  if (source->counts()) return MergeResult::kDone;
  source->set_counts(true);
  touch_all(*source);
  return MergeResult::kDone;
}

MergeResult MergeMap::remove_layer(const LayerId& id) {
  const MergeResult retracted = retract_layer(id);
  if (retracted != MergeResult::kDone) return retracted;
  const auto entry = order_.find(foreign_id(id));
  sources_[entry->second].reset();
  order_.erase(entry);
  return MergeResult::kDone;
}

MergeResult MergeMap::add(std::unique_ptr<MergeSource> source) {
  if (order_.contains(source->id())) return MergeResult::kKnownLayer;
  if (order_.size() == kLayersMax) return MergeResult::kTooManyLayers;
  std::size_t index = 1;
  while (index < sources_.size() && sources_[index] != nullptr) ++index;
  if (index == sources_.size()) sources_.push_back(nullptr);
  sources_[index] = std::move(source);
  order_.emplace(sources_[index]->id(), static_cast<SourceIndex>(index));
  touch_all(*sources_[index]);
  return MergeResult::kDone;
}

MergeSource* MergeMap::find(const MergeSourceId& id) const {
  const auto found = order_.find(id);
  return found == order_.end() ? nullptr : sources_[found->second].get();
}

std::optional<MergePlacement> MergeMap::place(const Eigen::Isometry3d& T_merge_layer,
                                              double resolution_m) const {
  return MergePlacement::at(T_merge_layer, resolution_m, config_.resolution_m);
}

MergeResult MergeMap::move(const MergeSourceId& id, const Eigen::Isometry3d& T_merge_layer) {
  MergeSource* const source = find(id);
  if (source == nullptr) return MergeResult::kUnknownLayer;
  const auto placement = place(T_merge_layer, source->resolution_m());
  if (!placement) return MergeResult::kBadPose;
  if (!source->counts()) {
    source->move(*placement);
    return MergeResult::kDone;
  }
  untouch_all(*source);
  source->move(*placement);
  touch_all(*source);
  forget_untouched_regions();
  return MergeResult::kDone;
}

void MergeMap::update_block(MergeSource& source, BlockOrdinal block) {
  const bool was_known = source.known_blocks().contains(block);
  const bool is_known = source.has_codes(block);
  if (is_known && !was_known) {
    source.known_blocks().insert(block);
    touch(source, block);
  } else if (!is_known && was_known) {
    source.known_blocks().erase(block);
    untouch(source, block);
  }
  if (is_known || was_known) mark_changed(source, block);
}

void MergeMap::touch_all(MergeSource& source) {
  begin_change();
  source.for_each_block([&](BlockOrdinal block) { update_block(source, block); });
}

void MergeMap::untouch_all(MergeSource& source) {
  begin_change();
  for (const BlockOrdinal block : source.known_blocks()) {
    mark_changed(source, block);
    untouch(source, block);
  }
  source.known_blocks().clear();
}

void MergeMap::touch(const MergeSource& source, BlockOrdinal block) {
  const BlockBox box = source.placement().blocks_in_merge(block_key_of(block));
  blocks_outside_ += box.clipped ? 1 : 0;
  box.for_each([&](const BlockKey& key) { index_.touch(key); });
}

void MergeMap::untouch(const MergeSource& source, BlockOrdinal block) {
  const BlockBox box = source.placement().blocks_in_merge(block_key_of(block));
  blocks_outside_ -= box.clipped ? 1 : 0;
  box.for_each([&](const BlockKey& key) { index_.untouch(key); });
}

void MergeMap::mark_changed(const MergeSource& source, BlockOrdinal block) {
  source.placement().blocks_in_merge(block_key_of(block)).for_each([&](const BlockKey& key) {
    cache_.drop(index_.mark_changed(key, changes_));
  });
}

void MergeMap::forget_untouched_regions() {
  if (index_.untouched_regions() <= kUntouchedRegionsMax) return;
  index_.forget_untouched();
  forgotten_until_ = changes_;
}

std::size_t MergeMap::memory_bytes() const {
  std::size_t bytes = index_.memory_bytes() + cache_.memory_bytes();
  for (const auto& source : sources_) bytes += source != nullptr ? source->memory_bytes() : 0;
  return bytes;
}

}  // namespace warren
