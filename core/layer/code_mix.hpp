// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "core/layer/code_block.hpp"

namespace warren {

// Which codes occur among some voxels: kept so small that a layer's blocks can each have one.
class CodeMix {
 public:
  CodeMix() = default;  // of no voxels
  explicit CodeMix(VoxelCode code);
  // Of the voxels [first, first + count) of a block in Morton order. Precondition: they lie in one
  // cell, or are whole cells.
  static CodeMix of(const BlockCodes& codes, std::uint32_t first, std::uint32_t count);

  CodeMix& operator|=(const CodeMix& other);

  // The one code that all have, or nothing.
  std::optional<VoxelCode> uniform() const {
    return uniform_ ? std::optional(code_) : std::nullopt;
  }
  // One code for all that never promises more than the worst of them. Occupied if any is, a stair
  // if any is, with the highest cost; but without data if any occupied voxel is so and the others
  // would pass for easy ground. Else unknown if any is unknown, else free.
  VoxelCode worst() const;

 private:
  VoxelCode code_;  // of all, if uniform
  bool uniform_ = false;
  bool any_ = false;
  bool unknown_ = false;
  bool occupied_ = false;
  bool without_data_ = false;
  bool stair_ = false;
  CostCode highest_ = kNoCostData;
};

}  // namespace warren
