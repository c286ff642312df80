// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/layer/code_block.hpp"
#include "core/voxel/key.hpp"

namespace warren::test {

// What a subscriber keeps, read by nothing but the words of docs/PROTOCOL.md.
class BlockCopy {
 public:
  // x fastest, then y.
  using Rows = std::array<std::uint8_t, kVoxelsPerBlock>;

  // False if the codes are not those of so many blocks.
  bool apply(bool anew, const std::vector<BlockKey>& keys, const std::string& codes);

  std::uint8_t code(const VoxelKey& key) const;
  // Of all known voxels.
  std::map<VoxelKey, std::uint8_t> known() const;
  std::size_t blocks() const { return blocks_.size(); }

 private:
  std::map<BlockKey, Rows> blocks_;
};

}  // namespace warren::test
