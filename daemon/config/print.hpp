// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.hpp"

namespace warren {

// Every key with its value, as YAML that loads back equal.
std::string print_config(const Config& config);
// The same with what each key means, may be and needs: config/robot.yaml is this text of the
// defaults.
std::string print_sample(const Config& config);

struct ConfigChanges {
  std::vector<std::string> effective;      // keys that a running daemon can take over
  std::vector<std::string> needs_restart;  // keys that it cannot
};
ConfigChanges compare_configs(const Config& before, const Config& after);

// `running` with everything of `wanted` that a running daemon can take over.
Config reloaded(const Config& running, const Config& wanted);

}  // namespace warren
