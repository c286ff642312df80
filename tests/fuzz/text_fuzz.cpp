// SPDX-License-Identifier: Apache-2.0
// A cloud of text: at most a point per line, and the points read back the same once printed.
#include <array>
#include <charconv>

#include "tests/fuzz/cloud_checks.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

constexpr std::size_t kMinPointBytes = 6;  // "0 0 0\n", whose last line may lack its end

std::string printed(const Cloud& cloud) {
  std::string text;
  std::array<char, 32> buffer{};
  for (const Point3f& point : cloud.points) {
    for (const float value : {point.x, point.y, point.z}) {
      const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
      text.append(buffer.data(), end).append(1, ' ');
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto cloud = decode_text_cloud(bytes);
  if (!cloud) {
    fuzz::check_error(cloud.error(), bytes);
    return 0;
  }
  assert(cloud->points.size() * fuzz::kMinPointBytes <= size + 1);
  const auto again = decode_text_cloud(fuzz::printed(*cloud));
  assert(again && fuzz::same_points(again->points, cloud->points));
  return 0;
}
