// SPDX-License-Identifier: Apache-2.0
#include "core/layer/code_mix.hpp"

#include <algorithm>

namespace warren {
CodeMix::CodeMix(VoxelCode code)
    : code_(code),
      uniform_(true),
      any_(true),
      unknown_(code.state() == VoxelState::kUnknown),
      occupied_(code.state() == VoxelState::kOccupied),
      without_data_(occupied_ && code.cost() == kNoCostData),
      stair_(code.stair()),
      highest_(code.cost()) {}

CodeMix CodeMix::of(const BlockCodes& codes, std::uint32_t first, std::uint32_t count) {
  CodeMix mix;
  for (std::uint32_t done = 0; done < count; done += 64) {
    const std::size_t cell = (first + done) >> 6;
    const std::uint64_t bits = count >= 64 ? kFullCell : (std::uint64_t{1} << count) - 1;
    const std::uint64_t part = bits << (first & 63);
    if ((~codes.known[cell] & part) != 0) mix |= CodeMix(VoxelCode{});
    if ((codes.known[cell] & ~codes.occupied[cell] & part) != 0) mix |= CodeMix(VoxelCode::free());
    for_each_bit(codes.occupied[cell] & part, [&](std::uint32_t bit) {
      mix |= CodeMix(codes.at(static_cast<std::uint32_t>(cell) << 6 | bit));
    });
  }
  return mix;
}

CodeMix& CodeMix::operator|=(const CodeMix& other) {
  if (!other.any_) return *this;
  if (!any_) return *this = other;
  uniform_ = uniform_ && other.uniform_ && code_ == other.code_;
  unknown_ |= other.unknown_;
  occupied_ |= other.occupied_;
  without_data_ |= other.without_data_;
  stair_ |= other.stair_;
  highest_ = std::max(highest_, other.highest_);
  return *this;
}

VoxelCode CodeMix::worst() const {
  if (occupied_) {
    const bool hides_nothing = !without_data_ || !is_safe(highest_, kSafeMostCost);
    return VoxelCode::occupied(hides_nothing ? highest_ : kNoCostData, stair_);
  }
  return unknown_ || !any_ ? VoxelCode{} : VoxelCode::free();
}

}  // namespace warren
