// SPDX-License-Identifier: Apache-2.0
#include "tests/support/recorded_data.hpp"

#include <cstdlib>

#include <doctest/doctest.h>

namespace warren::test {

std::optional<std::filesystem::path> recorded_file(const std::string& name) {
  const char* const data = std::getenv("WARREN_DATA");
  const std::filesystem::path path =
      (data != nullptr ? std::filesystem::path(data) : WARREN_SOURCE_DIR "/../shared/data") / name;
  if (std::filesystem::exists(path)) return path;
  MESSAGE("SKIPPED: no recorded data at ", path.string());
  return std::nullopt;
}

UnpackedData::UnpackedData(const std::string& archive) {
  const auto file = recorded_file(archive);
  if (!file) return;
  std::string pattern = (std::filesystem::temp_directory_path() / "warren-test-XXXXXX").string();
  REQUIRE(mkdtemp(pattern.data()) != nullptr);
  folder_ = pattern;
  const bool is_tar = archive.ends_with(".tar.xz");
  const std::string command = is_tar ? "tar -xJf '" + file->string() + "' -C '" + pattern + "'"
                                     : "bunzip2 -c '" + file->string() + "' > '" +
                                           (folder_ / file->filename().stem()).string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
}

UnpackedData::~UnpackedData() {
  if (!folder_.empty()) std::filesystem::remove_all(folder_);
}

}  // namespace warren::test
