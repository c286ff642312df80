// SPDX-License-Identifier: Apache-2.0
// A PCD file: no more points than its bytes can hold, and none missing when it is cut short.
#include "tests/fuzz/cloud_checks.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

// LZF makes at most 88 bytes out of one, and a point takes 12.
constexpr std::size_t kMaxPointsPerByte = 8;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto cloud = decode_pcd(bytes);
  if (!cloud) {
    fuzz::check_error(cloud.error(), bytes);
    return 0;
  }
  assert(cloud->points.size() <= size * kMaxPointsPerByte);
  fuzz::check_cut_short(decode_pcd, bytes, *cloud);
  return 0;
}
