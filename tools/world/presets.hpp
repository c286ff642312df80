// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/world/world.hpp"

namespace warren::world {

// One function per preset, each in the file of its name. A length of 0 is the preset's own.
World make_cave(const WorldSpec& spec);
World make_tunnel(const WorldSpec& spec);
World make_urban(const WorldSpec& spec);
World make_mine(const WorldSpec& spec);
World make_room(const WorldSpec& spec);
// Reads the Edgar mine's mesh from $WARREN_DATA, or else ../shared/data beside the sources.
tl::expected<World, std::string> make_edgar(const WorldSpec& spec);

}  // namespace warren::world
