// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "daemon/config/config.hpp"

namespace warren {

// One sentence per fault, in the order of lines: file:line, key, value, what is allowed.
using ConfigFaults = std::vector<std::string>;

inline constexpr std::size_t kMaxConfigBytes = 1 << 20;

// Strict: unknown and duplicate keys, wrong types and ranges and contradictions are all faults, and
// all are told at once. Keys left out have their defaults. `name` stands in the messages.
tl::expected<Config, ConfigFaults> parse_config(const std::string& yaml, const std::string& name);
tl::expected<Config, ConfigFaults> load_config(const std::filesystem::path& file);

// The faults, one per line.
std::string join_lines(const ConfigFaults& faults);

}  // namespace warren
