// SPDX-License-Identifier: Apache-2.0
#include "daemon/config_commands.hpp"

#include <iostream>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"

namespace warren {

int check_config_command(const std::filesystem::path& file) {
  const auto config = load_config(file);
  if (config) {
    std::cout << file.string() << ": fine\n";
    return 0;
  }
  std::cerr << join_lines(config.error()) << "\n";
  return kExitConfigError;
}

int print_config_command(const std::filesystem::path& file) {
  const auto config =
      file.empty() ? tl::expected<Config, ConfigFaults>(Config{}) : load_config(file);
  if (config) {
    std::cout << print_config(*config);
    return 0;
  }
  std::cerr << join_lines(config.error()) << "\n";
  return kExitConfigError;
}

}  // namespace warren
