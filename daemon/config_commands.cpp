// SPDX-License-Identifier: Apache-2.0
#include "daemon/config_commands.hpp"

#include <iostream>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "daemon/key_file.hpp"

namespace warren {
namespace {

// No fault of the config: the file may be read by the daemon alone, or be copied there later.
void warn_of_key(const MeshSettings& mesh) {
  if (!mesh.is_on()) return;
  const auto key = read_key_file(mesh.key_file);
  if (!key) std::cerr << "warning: for this user, " << key.error() << "\n";
}

}  // namespace

int check_config_command(const std::filesystem::path& file) {
  const auto config = load_config(file);
  if (config) {
    std::cout << file.string() << ": fine\n";
    warn_of_key(config->mesh);
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
