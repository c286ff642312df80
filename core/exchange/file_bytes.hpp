// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

namespace warren {

// The whole content of a regular file of at most `max_bytes`. The error names the file.
tl::expected<std::string, std::string> read_file_bytes(const std::filesystem::path& file,
                                                       std::uint64_t max_bytes);

// An error that names the file.
inline tl::unexpected<std::string> file_failure(const std::filesystem::path& file,
                                                const std::string& why) {
  return tl::make_unexpected(file.string() + ": " + why);
}

}  // namespace warren
