// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/layer_book.hpp"

#include <cassert>
#include <chrono>
#include <utility>

#include "core/layer/packet_header.hpp"

namespace warren::replication {
namespace {

std::vector<StoredBlock> stored_blocks(const Replica& replica,
                                       const std::set<BlockOrdinal>& changed) {
  std::vector<StoredBlock> blocks;
  for (const BlockOrdinal ordinal : changed) {
    const LayerBlock* const block = replica.find(ordinal);
    if (block != nullptr) blocks.push_back({ordinal, block->history.latest(), block->codes});
  }
  return blocks;
}

}  // namespace

HeldLayer& LayerBook::insert(const LayerId& id) {
  layers_.push_back(std::make_unique<HeldLayer>());
  HeldLayer& layer = *layers_.back();
  layer.id = id;
  layer.slot = static_cast<Slot>(layers_.size() - 1);
  by_id_[id] = &layer;
  return layer;
}

bool LayerBook::add_own(const Replica& layer) {
  if (layers_.size() >= kSlotsMax || by_id_.contains(layer.id())) return false;
  assert(layer.holdings().intervals().size() == 1);
  HeldLayer& held = insert(layer.id());
  held.own = &layer;
  held.stored = layer.holdings();
  held.batched = layer.holdings().at(0);
  return true;
}

bool LayerBook::restore(std::unique_ptr<Replica> copy) {
  if (layers_.size() >= limits_.layers_max || by_id_.contains(copy->id())) return false;
  // It may have been at rest when it was stored: all of it at once is many times as much.
  if (restored_bytes_ + copy->memory_bytes() > limits_.copies_bytes_max / 2) {
    (void)copy->rest(copy->holdings().highest({}), copy->regions());
  }
  restored_bytes_ += copy->memory_bytes();
  HeldLayer& held = insert(copy->id());
  held.stored = copy->holdings();
  held.copy = std::move(copy);
  return true;
}

Admission LayerBook::admit(const LayerId& id, Resolution resolution) {
  if (HeldLayer* const held = find(id)) {
    if (held->own != nullptr) return Admission::kOwnLayer;
    return held->copy->resolution() == resolution ? Admission::kKnown : Admission::kOtherResolution;
  }
  if (layers_.size() >= limits_.layers_max) {
    ++layers_refused_;
    return Admission::kFull;
  }
  insert(id).copy = std::make_unique<Replica>(id, resolution);
  return Admission::kAdmitted;
}

void LayerBook::on_published(MeshTime now, const LayerId& id) {
  HeldLayer* const layer = find(id);
  if (layer == nullptr || layer->own == nullptr) return;
  note_change(now, *layer);
}

void LayerBook::note_change(MeshTime now, HeldLayer& layer) {
  layer.changed = now;
  ++layer.version;
  layer.times.note(layer.highest(), now);
}

LayerBook::Applied LayerBook::refuse(Refusal reason) {
  ++refused_[static_cast<std::size_t>(reason)];
  return {ApplyResult::kOtherLayer, reason, std::nullopt};
}

// Adding up takes longer than applying a packet, and a packet adds a few kilobytes at most.
bool LayerBook::is_out_of_memory() {
  constexpr std::uint32_t kPacketsBetween = 64;
  if (applied_++ % kPacketsBetween == 0) {
    out_of_memory_ = memory_bytes() >= limits_.copies_bytes_max;
  }
  return out_of_memory_;
}

void LayerBook::review_room(MeshTime now) {
  constexpr auto kBetween = std::chrono::seconds(10);
  if (!out_of_memory_ || (reviewed_ != MeshTime::min() && now < reviewed_ + kBetween)) return;
  reviewed_ = now;
  // Not at the first byte that is free: it would stop again at once.
  if (memory_bytes() >= limits_.copies_bytes_max - limits_.copies_bytes_max / 8) return;
  out_of_memory_ = false;
  applied_ = 0;
  for (const auto& layer : layers_) {
    if (layer->copy) layer->full = layer->copy->regions() >= limits_.regions_max;
  }
}

LayerBook::Applied LayerBook::apply(MeshTime now, HeldLayer& layer,
                                    std::span<const std::uint8_t> packet) {
  if (layer.own != nullptr) return refuse(Refusal::kOwnLayer);
  if (layer.copy->regions() >= limits_.regions_max || is_out_of_memory()) {
    layer.full = true;
    return refuse(Refusal::kNoRoom);
  }
  Applied applied;
  applied.result = layer.copy->apply(layer.id, packet);
  ++apply_counts_[static_cast<std::size_t>(applied.result)];
  if (const auto header = read_header(packet)) applied.claim = header->claim;
  if (applied.result != ApplyResult::kApplied) return applied;
  note_change(now, layer);
  note_touched(layer, applied.claim->keys, applied.claim->from);
  return applied;
}

// A block may have another revision of last change and the same codes: the store needs it, or the
// copy would pass over it in a diff one day.
void LayerBook::note_touched(HeldLayer& layer, const KeyInterval& keys, Revision from) {
  layer.copy->for_each_changed(keys, from, [&](BlockOrdinal block, const LayerBlock&) {
    layer.not_batched.insert(block);
    return true;
  });
}

bool LayerBook::forget(MeshTime now, HeldLayer& layer, const KeyInterval& keys) {
  if (layer.own != nullptr) return false;
  if (!layer.copy->forget(keys)) return false;
  layer.forgotten.push_back(keys);
  note_change(now, layer);
  return true;
}

HeldLayer* LayerBook::find(const LayerId& id) {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

const HeldLayer* LayerBook::find(const LayerId& id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

bool LayerBook::is_behind_store(const HeldLayer& layer) const {
  if (layer.own != nullptr) return layer.own->holdings().at(0) != layer.batched;
  if (!layer.not_batched.empty() || !layer.forgotten.empty()) return true;
  for (auto batched = batched_.rbegin(); batched != batched_.rend(); ++batched) {
    if (batched->layer == layer.id) return batched->holdings != layer.copy->holdings();
  }
  return layer.stored != layer.copy->holdings();
}

bool LayerBook::has_unstored() const {
  for (const auto& layer : layers_) {
    if (is_behind_store(*layer)) return true;
  }
  return false;
}

std::vector<StoredLayer> LayerBook::take_batch(std::uint64_t batch) {
  std::vector<StoredLayer> stored;
  for (const auto& layer : layers_) {
    if (!is_behind_store(*layer)) continue;
    const Replica& replica = layer->replica();
    stored.push_back({layer->id,
                      replica.resolution(),
                      layer->own != nullptr,
                      replica.pose(),
                      replica.holdings(),
                      std::exchange(layer->forgotten, {}),
                      {}});
    auto& blocks = stored.back().blocks;
    if (layer->own != nullptr) {
      replica.for_each_changed({}, layer->batched, [&](BlockOrdinal block, const LayerBlock& now) {
        blocks.push_back({block, now.history.latest(), now.codes});
        return true;
      });
      layer->batched = replica.holdings().at(0);
    } else {
      blocks = stored_blocks(replica, layer->not_batched);
      layer->not_batched.clear();
    }
    batched_.push_back({batch, layer->id, replica.holdings()});
  }
  return stored;
}

std::vector<HeldLayer*> LayerBook::on_stored(std::uint64_t batch) {
  std::vector<HeldLayer*> moved;
  while (!batched_.empty() && batched_.front().batch <= batch) {
    HeldLayer* const layer = find(batched_.front().layer);
    layer->stored = std::move(batched_.front().holdings);
    moved.push_back(layer);
    batched_.pop_front();
  }
  return moved;
}

void LayerBook::on_refused(std::uint64_t batch) {
  for (auto batched = batched_.begin(); batched != batched_.end();) {
    if (batched->batch != batch) {
      ++batched;
      continue;
    }
    HeldLayer& layer = *find(batched->layer);
    if (layer.own != nullptr) {
      layer.batched = layer.stored.at(0);
    } else {
      layer.forgotten = {KeyInterval{}};
      note_touched(layer, {}, {});
    }
    batched = batched_.erase(batched);
  }
}

std::size_t LayerBook::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto& layer : layers_) {
    bytes += sizeof(HeldLayer) + layer->not_batched.size() * 48;
    if (layer->copy) bytes += layer->copy->memory_bytes();
  }
  return bytes;
}

}  // namespace warren::replication
