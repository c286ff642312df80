// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/cloud_reader.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <system_error>

#include "core/exchange/cloud_decoders.hpp"
#include "core/exchange/file_bytes.hpp"
#include "core/exchange/file_ending.hpp"
#include "core/exchange/natural_order.hpp"

namespace warren {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnownEndings = ".pcd .ply .bin .txt .xyz .dat .csv";
constexpr std::size_t kMaxDirectoryEntries = 10'000'000;

using Decoder = Decoded<Cloud> (*)(std::string_view);

Decoder decoder_of(const fs::path& file) {
  struct Entry {
    const char* ending;
    Decoder decode;
  };
  constexpr std::array<Entry, 7> kDecoders = {{{".pcd", decode_pcd},
                                               {".ply", decode_ply},
                                               {".bin", decode_kitti_bin},
                                               {".txt", decode_text_cloud},
                                               {".xyz", decode_text_cloud},
                                               {".dat", decode_text_cloud},
                                               {".csv", decode_text_cloud}}};
  const std::string ending = lower_case_ending(file);
  for (const Entry& entry : kDecoders) {
    if (ending == entry.ending) return entry.decode;
  }
  return nullptr;
}

}  // namespace

tl::expected<Cloud, std::string> read_cloud(const fs::path& file) {
  const Decoder decode = decoder_of(file);
  if (decode == nullptr) {
    return file_failure(file, std::string("no cloud by its ending; known are ") + kKnownEndings);
  }
  const auto bytes = read_file_bytes(file, kMaxCloudFileBytes);
  if (!bytes) return tl::make_unexpected(bytes.error());
  try {
    auto cloud = decode(*bytes);
    if (!cloud) return tl::make_unexpected(cloud.error().located(file.string()));
    return *std::move(cloud);
  } catch (const std::bad_alloc&) {
    return file_failure(file, "not enough memory for its points");
  }
}

tl::expected<std::vector<fs::path>, std::string> list_clouds(const fs::path& file_or_directory) {
  std::error_code error;
  const auto status = fs::status(file_or_directory, error);
  if (!fs::exists(status)) return file_failure(file_or_directory, "no such file or directory");
  if (!fs::is_directory(status)) return std::vector<fs::path>{file_or_directory};
  std::vector<fs::path> clouds;
  std::vector<fs::path> texts;
  std::size_t entries = 0;
  for (fs::directory_iterator it(file_or_directory, error), end; !error && it != end;
       it.increment(error)) {
    if (++entries > kMaxDirectoryEntries) return file_failure(file_or_directory, "too many files");
    std::error_code ignored;
    const Decoder decode = decoder_of(it->path());
    if (decode == nullptr || !it->is_regular_file(ignored)) continue;
    (decode == decode_text_cloud ? texts : clouds).push_back(it->path());
  }
  if (error) return file_failure(file_or_directory, error.message());
  if (clouds.empty()) clouds = std::move(texts);
  if (clouds.empty()) {
    return file_failure(file_or_directory,
                        std::string("holds no cloud; known are ") + kKnownEndings);
  }
  std::sort(clouds.begin(), clouds.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return clouds;
}

}  // namespace warren
