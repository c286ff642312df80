// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/decode_error.hpp"
#include "core/layer/coded_block.hpp"
#include "core/layer/replica.hpp"

namespace warren {

inline constexpr std::uint64_t kOctomapFileBytesMax = std::uint64_t{256} << 20;
// Some 15 km of tunnel at 0.1 m. Pruned leaves can stand for any number of blocks.
inline constexpr std::size_t kOctomapBlocksMax = std::size_t{1} << 19;

struct OctomapTree {
  Resolution resolution;
  std::vector<CodedBlock> blocks;  // in key order; occupied voxels have no cost data
};

// Reads an OctoMap tree of type OcTree: of a .bt the states, of an .ot what its log-odds say at
// OctoMap's own threshold of 0.5. Never throws but for memory; bounded on any input.
Decoded<OctomapTree> decode_octomap(std::string_view bytes);

// As a layer of `origin` that nobody goes on writing. The same file gives the same layer id.
tl::expected<Replica, std::string> read_octomap(const std::filesystem::path& file,
                                                std::uint32_t origin);

}  // namespace warren
