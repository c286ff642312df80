// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "tools/world/world.hpp"

namespace warren::world {

// Writes DIR/{outside,cutaway,plan,robot}.png, 1600x900: the world as a solid seen from outside;
// with all that lies higher than 2 m above the passages' floor cut away; straight from above,
// likewise; and what a robot at the start sees.
tl::expected<void, std::string> render(const World& world, const std::filesystem::path& directory);

}  // namespace warren::world
