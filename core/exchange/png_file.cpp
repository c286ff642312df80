// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include <png.h>

#include "core/exchange/image.hpp"

namespace warren {

static_assert(sizeof(Colour) == 3, "libpng reads rows of packed colours");

tl::expected<void, std::string> write_png(const Image& image, const std::filesystem::path& file) {
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width());
  header.height = static_cast<png_uint_32>(image.height());
  header.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&header, file.c_str(), 0, &image.at(0, 0), 0, nullptr) != 0) {
    return {};
  }
  return tl::make_unexpected(std::string(header.message));
}

}  // namespace warren
