// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/exchange/image.hpp"
#include "core/exchange/merged_snapshot.hpp"

namespace warren {

// How many sources have a colour of their own; all further ones share one grey.
inline constexpr std::size_t kSourceColours = 8;

// White is this robot; others have the colours of Okabe and Ito, "Color Universal Design" (2008),
// which people with any colour vision tell apart.
Colour colour_of_source(SourceNumber source);

// "robot-2 layer 1", or "robot 7 layer 1" of a node without a name.
std::string short_name_of(const LayerId& layer, const std::string& node);
// "source 1: robot 7 layer 1 incarnation 00000000000000ab robot-2". Source 0 is "this robot".
std::string line_of_source(SourceNumber source, const std::vector<LayerId>& others,
                           const std::vector<std::string>& names);

}  // namespace warren
