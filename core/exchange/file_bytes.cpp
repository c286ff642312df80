// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/file_bytes.hpp"

#include <fstream>
#include <new>
#include <system_error>

namespace warren {
tl::expected<std::string, std::string> read_file_bytes(const std::filesystem::path& file,
                                                       std::uint64_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return file_failure(file, "no such file");
  if (!std::filesystem::is_regular_file(status)) return file_failure(file, "not a regular file");
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error) return file_failure(file, error.message());
  if (size > max_bytes) {
    return file_failure(
        file, std::to_string(size) + " bytes; at most " + std::to_string(max_bytes) + " are read");
  }
  try {
    std::string bytes(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return file_failure(file, "cannot be opened for reading");
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    const bool whole = static_cast<std::uint64_t>(stream.gcount()) == size;
    if (!whole) return file_failure(file, "read failed");
    return bytes;
  } catch (const std::bad_alloc&) {
    return file_failure(file, "not enough memory for its " + std::to_string(size) + " bytes");
  }
}

}  // namespace warren
