// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace warren::test {

// A file of the recorded data, below $WARREN_DATA or ../shared/data beside the sources. When it is
// absent this says "SKIPPED:" with its name, which makes CTest count the case as skipped.
std::optional<std::filesystem::path> recorded_file(const std::string& name);

// A recorded archive (.tar.xz, .bz2), unpacked into a folder that lives as long as this object.
class UnpackedData {
 public:
  explicit UnpackedData(const std::string& archive);
  ~UnpackedData();
  UnpackedData(const UnpackedData&) = delete;
  UnpackedData& operator=(const UnpackedData&) = delete;

  bool is_there() const { return !folder_.empty(); }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace warren::test
