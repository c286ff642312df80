// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace warren {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};

// The colour with its brightness scaled, clamped to white.
Colour shaded(const Colour& colour, float brightness);

// In pixels, from the upper left corner.
struct Rectangle {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

class Image {
 public:
  Image(int width, int height, const Colour& background);

  int width() const { return width_; }
  int height() const { return height_; }
  // Precondition: inside the image.
  Colour& at(int x, int y) { return pixels_[index(x, y)]; }
  const Colour& at(int x, int y) const { return pixels_[index(x, y)]; }

  // Both clip at the border.
  void fill(const Rectangle& area, const Colour& colour);
  // `left`, `top`: of the first letter; `dot`: edge of a letter's dot in pixels.
  void draw_text(int left, int top, std::string_view text, const Colour& colour, int dot = 2);
  static int text_width(std::string_view text, int dot = 2);

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Colour> pixels_;
};

tl::expected<void, std::string> write_png(const Image& image, const std::filesystem::path& file);

}  // namespace warren
