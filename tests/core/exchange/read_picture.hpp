// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <vector>

#include <doctest/doctest.h>
#include <png.h>

#include "core/exchange/image.hpp"

namespace warren::test {

struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgb;

  std::size_t colours() const {
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
      seen.insert(static_cast<std::uint32_t>(rgb[i] << 16 | rgb[i + 1] << 8 | rgb[i + 2]));
    }
    return seen.size();
  }

  // Also where it is a little darker, as on surfaces.
  std::size_t pixels_like(const Colour& colour) const {
    const auto like = [](std::uint8_t a, std::uint8_t b) { return std::abs(a - b) <= 16; };
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
      const bool all = like(rgb[i], colour.red) && like(rgb[i + 1], colour.green) &&
                       like(rgb[i + 2], colour.blue);
      count += all ? 1 : 0;
    }
    return count;
  }
};

inline Picture read_png(const std::filesystem::path& file) {
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&header, file.c_str()) != 0);
  header.format = PNG_FORMAT_RGB;
  Picture picture{header.width, header.height, {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(header));
  REQUIRE(png_image_finish_read(&header, nullptr, picture.rgb.data(), 0, nullptr) != 0);
  return picture;
}

}  // namespace warren::test
