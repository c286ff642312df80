// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace warren {

// Letters for pictures, so that these need no font on the robot: 5 dots wide, 8 high (the last row
// is for descenders).
inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 8;

// Bit 5 * row + column is set where there is ink. Has digits, lower case and ".,:-+/()%"; all else
// is blank.
std::uint64_t glyph_dots(char letter);

}  // namespace warren
