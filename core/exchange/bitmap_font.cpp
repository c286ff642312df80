// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/bitmap_font.hpp"

#include <algorithm>
#include <array>

namespace warren {
namespace {

struct Glyph {
  char letter;
  std::uint64_t dots;
};

// Sorted by letter.
constexpr std::array<Glyph, 46> kGlyphs = {
    {{' ', 0x0000000000ULL}, {'%', 0x0672222273ULL}, {'(', 0x0208210888ULL}, {')', 0x0088842082ULL},
     {'+', 0x0109F21000ULL}, {',', 0x1108000000ULL}, {'-', 0x0000E00000ULL}, {'.', 0x0100000000ULL},
     {'/', 0x0042222210ULL}, {'0', 0x03A318C62EULL}, {'1', 0x07C84214C4ULL}, {'2', 0x07C226422EULL},
     {'3', 0x03A306422EULL}, {'4', 0x0211F4A988ULL}, {'5', 0x03A3083C3FULL}, {'6', 0x03A317844CULL},
     {'7', 0x010844221FULL}, {'8', 0x03A317462EULL}, {'9', 0x01910F462EULL}, {':', 0x0100001000ULL},
     {'a', 0x07A3E83800ULL}, {'b', 0x03E318BC21ULL}, {'c', 0x038210B800ULL}, {'d', 0x07A318FA10ULL},
     {'e', 0x0383F8B800ULL}, {'f', 0x0084213C4CULL}, {'g', 0x743D18F800ULL}, {'h', 0x046318BC21ULL},
     {'i', 0x0388421804ULL}, {'j', 0x3210843008ULL}, {'k', 0x024A32A421ULL}, {'l', 0x0388421086ULL},
     {'m', 0x056B5AAC00ULL}, {'n', 0x046318BC00ULL}, {'o', 0x03A318B800ULL}, {'p', 0x085F18BC00ULL},
     {'q', 0x843D18F800ULL}, {'r', 0x004211B400ULL}, {'s', 0x03E0E0F800ULL}, {'t', 0x0304213C42ULL},
     {'u', 0x07A318C400ULL}, {'v', 0x011518C400ULL}, {'w', 0x02AB5AD400ULL}, {'x', 0x0454454400ULL},
     {'y', 0x743D18C400ULL}, {'z', 0x07C4447C00ULL}}};

}  // namespace

std::uint64_t glyph_dots(char letter) {
  const auto* const found =
      std::lower_bound(kGlyphs.begin(), kGlyphs.end(), letter,
                       [](const Glyph& glyph, char wanted) { return glyph.letter < wanted; });
  return found != kGlyphs.end() && found->letter == letter ? found->dots : 0;
}

}  // namespace warren
