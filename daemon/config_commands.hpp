// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace warren {

inline constexpr int kExitConfigError = 2;

// What warrend and warrenctl share: they write to stdout and stderr and return the exit code.
int check_config_command(const std::filesystem::path& file);
// An empty path: the defaults.
int print_config_command(const std::filesystem::path& file);

}  // namespace warren
