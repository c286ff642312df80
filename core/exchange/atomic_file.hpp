// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <tl/expected.hpp>

namespace warren {

using WriteResult = tl::expected<void, std::string>;

// Lets `write` fill a new file beside `file`, flushes it to disk and renames it over `file`. When
// anything fails, the new file is removed and an old one stays. Returns the bytes written. What
// `write` throws is an error too.
tl::expected<std::uint64_t, std::string> write_atomically(
    const std::filesystem::path& file,
    const std::function<WriteResult(const std::filesystem::path& temporary)>& write);

}  // namespace warren
