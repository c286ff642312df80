// SPDX-License-Identifier: Apache-2.0
#include "core/layer/merge_source.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/layer/merge_rule.hpp"

namespace warren {
namespace {

void add(SampledBlock& sampled, std::uint32_t place, VoxelCode code, std::int64_t changed_ns) {
  const bool another_state = code.state() != sampled.codes[place].state();
  if (another_state && code.state() < sampled.codes[place].state()) return;
  sampled.changed_ns[place] =
      another_state ? changed_ns : std::max(changed_ns, sampled.changed_ns[place]);
  sampled.codes[place] = safest(code, sampled.codes[place]);
}

std::uint32_t place_of(const VoxelKey& key) { return morton9(key.x, key.y, key.z); }

struct Candidate {
  CodeBlock codes;
  std::int64_t changed_ns = 0;
};

VoxelKey voxel_at(const BlockKey& block, std::uint32_t place) {
  const VoxelKey first = first_voxel_of(block);
  const VoxelKey within = place_of_morton9(place);
  return {first.x + within.x, first.y + within.y, first.z + within.z};
}

}  // namespace

MergeSource::MergeSource(std::uint32_t number, double resolution_m, const MergePlacement& placement)
    : id_{true, LayerId{0, number, 0}}, resolution_m_(resolution_m), placement_(placement) {}

MergeSource::MergeSource(const LayerId& id, const Replica& replica, double resolution_m,
                         const MergePlacement& placement)
    : id_{false, id}, resolution_m_(resolution_m), placement_(placement), replica_(&replica) {}

bool MergeSource::keep(const CodedBlock& block) {
  assert(replica_ == nullptr);
  if (block.codes.empty()) return own_blocks_.erase(block.block) > 0;
  const auto [kept, is_new] = own_blocks_.try_emplace(block.block, block.codes);
  if (is_new) return true;
  if (kept->second == block.codes) return false;
  kept->second = block.codes;
  return true;
}

bool MergeSource::has_codes(BlockOrdinal block) const {
  if (replica_ == nullptr) return own_blocks_.contains(block);
  const LayerBlock* const held = replica_->find(block);
  return held != nullptr && !held->codes.empty();
}

std::size_t MergeSource::memory_bytes() const {
  // A node and a bucket of a hash are about 32 bytes.
  std::size_t bytes = sizeof(MergeSource) + known_blocks_.size() * 32;
  for (const auto& entry : own_blocks_) {
    bytes += 32 + sizeof(CodeBlock) + entry.second.heap_bytes();
  }
  return bytes;
}

MergeSource::Found MergeSource::find(const BlockKey& block) const {
  const BlockOrdinal ordinal = ordinal_of(block);
  if (replica_ == nullptr) {
    const auto own = own_blocks_.find(ordinal);
    return own == own_blocks_.end() ? Found{} : Found{&own->second, 0};
  }
  const LayerBlock* const held = replica_->find(ordinal);
  if (held == nullptr || held->codes.empty()) return {};
  return {&held->codes, times_.time_ns(held->history.latest())};
}

bool MergeSource::sample(const BlockKey& merge_block, SampledBlock& sampled) const {
  sampled.codes.fill({});
  const BlockBox box = placement_.blocks_in_layer(merge_block);
  return placement_.is_shift() ? sample_shifted(merge_block, box, sampled)
                               : resample(merge_block, box, sampled);
}

bool MergeSource::sample_shifted(const BlockKey& merge_block, const BlockBox& box,
                                 SampledBlock& sampled) const {
  bool any = false;
  const VoxelKey target = first_voxel_of(merge_block);
  const auto& shift = placement_.shift();
  box.for_each([&](const BlockKey& key) {
    const Found found = find(key);
    if (found.codes == nullptr) return;
    const VoxelKey first = first_voxel_of(key);
    const auto x = static_cast<std::int32_t>(first.x + shift[0] - target.x);
    const auto y = static_cast<std::int32_t>(first.y + shift[1] - target.y);
    const auto z = static_cast<std::int32_t>(first.z + shift[2] - target.z);
    const bool whole_block = x == 0 && y == 0 && z == 0;
    found.codes->for_each_known([&](std::uint32_t place, VoxelCode code) {
      if (!whole_block) {
        const VoxelKey within = place_of_morton9(place);
        const VoxelKey moved{within.x + x, within.y + y, within.z + z};
        if (((moved.x | moved.y | moved.z) & ~7) != 0) return;
        place = place_of(moved);
      }
      sampled.codes[place] = code;
      sampled.changed_ns[place] = found.changed_ns;
      any = true;
    });
  });
  return any;
}

bool MergeSource::resample(const BlockKey& merge_block, const BlockBox& box,
                           SampledBlock& sampled) const {
  // Copies: what find() told of a region at rest is gone once it has read a few others.
  std::vector<Candidate> candidates;
  candidates.reserve(box.size());
  bool any = false;
  box.for_each([&](const BlockKey& key) {
    const Found found = find(key);
    candidates.push_back({found.codes != nullptr ? *found.codes : CodeBlock{}, found.changed_ns});
    if (found.codes == nullptr) return;
    any = true;
    for (std::uint32_t cell = 0; cell < kCellsPerBlock; ++cell) {
      for_each_bit(found.codes->occupied()[cell], [&](std::uint32_t bit) {
        const std::uint32_t place = cell << 6 | bit;
        const auto merge = placement_.to_merge(voxel_at(key, place));
        if (!merge || block_of(*merge) != merge_block) return;
        add(sampled, place_of(*merge), found.codes->at(place), found.changed_ns);
      });
    }
  });
  if (!any) return false;
  for (std::uint32_t place = 0; place < kVoxelsPerBlock; ++place) {
    const auto layer = placement_.to_layer(voxel_at(merge_block, place));
    const auto index = layer ? box.index_of(block_of(*layer)) : std::nullopt;
    if (!index || candidates[*index].codes.empty()) continue;
    const Candidate& candidate = candidates[*index];
    const VoxelCode code = candidate.codes.at(place_of(*layer));
    if (code.state() != VoxelState::kUnknown) add(sampled, place, code, candidate.changed_ns);
  }
  return true;
}

}  // namespace warren
