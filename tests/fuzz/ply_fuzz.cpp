// SPDX-License-Identifier: Apache-2.0
// A PLY file: no more points than its bytes can hold, and none missing when it is cut short.
#include "tests/fuzz/cloud_checks.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

constexpr std::size_t kMinPointBytes = 6;  // "0 0 0\n"

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto cloud = decode_ply(bytes);
  if (!cloud) {
    fuzz::check_error(cloud.error(), bytes);
    return 0;
  }
  assert(cloud->points.size() * kMinPointBytes <= size);
  fuzz::check_cut_short(decode_ply, bytes, *cloud);
  return 0;
}
