// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/image.hpp"

#include <algorithm>

#include "core/exchange/bitmap_font.hpp"

namespace warren {
namespace {

constexpr int kLetterGap = 1;  // dots

}  // namespace

Colour shaded(const Colour& colour, float brightness) {
  const auto scale = [brightness](std::uint8_t value) {
    return static_cast<std::uint8_t>(
        std::clamp(static_cast<float>(value) * brightness, 0.0F, 255.0F));
  };
  return {scale(colour.red), scale(colour.green), scale(colour.blue)};
}

Image::Image(int width, int height, const Colour& background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Image::fill(const Rectangle& area, const Colour& colour) {
  const int right = std::min(area.left + area.width, width_);
  const int bottom = std::min(area.top + area.height, height_);
  for (int y = std::max(area.top, 0); y < bottom; ++y) {
    for (int x = std::max(area.left, 0); x < right; ++x) at(x, y) = colour;
  }
}

void Image::draw_text(int left, int top, std::string_view text, const Colour& colour, int dot) {
  for (const char letter : text) {
    const std::uint64_t dots = glyph_dots(letter);
    for (int i = 0; i < kGlyphWidth * kGlyphHeight; ++i) {
      if ((dots >> i & 1) == 0) continue;
      fill({left + i % kGlyphWidth * dot, top + i / kGlyphWidth * dot, dot, dot}, colour);
    }
    left += (kGlyphWidth + kLetterGap) * dot;
  }
}

int Image::text_width(std::string_view text, int dot) {
  return static_cast<int>(text.size()) * (kGlyphWidth + kLetterGap) * dot;
}

}  // namespace warren
