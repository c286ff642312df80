// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "tools/world/tile_graph.hpp"

namespace warren::world {

// A SubT world's visibility graph. Text of the .dot: edges `A -- B [label=COST]` between numbered
// tiles. Bytes of the .dat: uint64 count, then per cubic metre of the world int32 x, y, z and
// uint64 tile, little endian. An error says what is wrong.
tl::expected<RadioTiles, std::string> parse_subt_tiles(std::string_view dot, std::string_view dat);

tl::expected<RadioTiles, std::string> read_subt_tiles(const std::filesystem::path& dot,
                                                      const std::filesystem::path& dat);

}  // namespace warren::world
