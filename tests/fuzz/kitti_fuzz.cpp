// SPDX-License-Identifier: Apache-2.0
// A KITTI cloud: every whole number of records is one, and its points are the file's very bits.
#include "tests/fuzz/cloud_checks.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren;
  constexpr std::size_t kRecordBytes = 16;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto cloud = decode_kitti_bin(bytes);
  assert(cloud.has_value() == (size % kRecordBytes == 0));
  if (!cloud) {
    fuzz::check_error(cloud.error(), bytes);
    return 0;
  }
  assert(cloud->points.size() * kRecordBytes == size);
  for (std::size_t i = 0; i < cloud->points.size(); ++i) {
    assert(std::memcmp(&cloud->points[i], data + i * kRecordBytes, sizeof(Point3f)) == 0);
  }
  return 0;
}
