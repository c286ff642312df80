// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/block_copy.hpp"

#include <algorithm>

namespace warren::test {
namespace {

// Reads one block from `at` on; false if the bytes end before it does, or a run goes beyond it.
bool read_runs(const std::string& bytes, std::size_t& at, BlockCopy::Rows& rows) {
  std::size_t told = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(bytes[at++]); };
  while (told < rows.size()) {
    if (at == bytes.size()) return false;
    const std::uint8_t first = next();
    std::size_t count = 1;
    if (first >= 128) {
      if (at == bytes.size()) return false;
      const std::uint8_t n = next();
      count = n == 255 ? rows.size() - told : std::size_t{n} + 2;
    }
    if (told + count > rows.size()) return false;
    for (; count > 0; --count) rows[told++] = first & 127;
  }
  return true;
}

}  // namespace

bool BlockCopy::apply(bool anew, const std::vector<BlockKey>& keys, const std::string& codes) {
  if (anew) blocks_.clear();
  std::size_t at = 0;
  for (const BlockKey& key : keys) {
    Rows rows{};
    if (!read_runs(codes, at, rows)) return false;
    const bool unknown = std::all_of(rows.begin(), rows.end(), [](auto code) { return code == 0; });
    if (unknown) {
      blocks_.erase(key);
    } else {
      blocks_[key] = rows;
    }
  }
  return at == codes.size();
}

std::uint8_t BlockCopy::code(const VoxelKey& key) const {
  const auto found = blocks_.find(block_of(key));
  if (found == blocks_.end()) return 0;
  return found->second[static_cast<std::size_t>((key.x & 7) + 8 * (key.y & 7) + 64 * (key.z & 7))];
}

std::map<VoxelKey, std::uint8_t> BlockCopy::known() const {
  std::map<VoxelKey, std::uint8_t> voxels;
  for (const auto& [block, rows] : blocks_) {
    const VoxelKey first = first_voxel_of(block);
    for (std::int32_t place = 0; place < 512; ++place) {
      const std::uint8_t code = rows[static_cast<std::size_t>(place)];
      if (code == 0) continue;
      voxels[{first.x + place % 8, first.y + place / 8 % 8, first.z + place / 64}] = code;
    }
  }
  return voxels;
}

}  // namespace warren::test
