// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace warren {

struct TrainOptions {
  std::vector<std::string> worlds{"tunnel", "cave", "urban", "mine"};
  std::vector<std::uint64_t> seeds{101, 102};
  double seconds = 60.0;
  std::vector<std::filesystem::path> clouds;
  std::filesystem::path out = "core/layer/diff_priors_table.inc";
};

// The options, or the status to exit with.
std::variant<TrainOptions, int> parse_command_line(int argc, char** argv);

}  // namespace warren
