// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace warren {

// Work on layer files, without the daemon.
struct LayerExportCommand {
  std::filesystem::path layer;
  std::filesystem::path file;
};
struct LayerImportCommand {
  std::filesystem::path tree;
  std::filesystem::path layer;
  std::uint32_t origin = 0;
};
struct LayerDiffCommand {
  std::filesystem::path a;
  std::filesystem::path b;
  bool json = false;
};
struct LayerDigestCommand {
  std::filesystem::path layer;
  bool regions = false;
};

// Of the running daemon.
struct LayerWatchCommand {
  int seconds = 0;
};
struct LayerFlushCommand {};

// Each prints its result and returns the exit code: 0, or 1 after an error. A diff returns 0 for
// equal layers, 1 for others and 2 after an error, as diff(1) does.
int run(const LayerExportCommand& command);
int run(const LayerImportCommand& command);
int run(const LayerDiffCommand& command);
int run(const LayerDigestCommand& command);

}  // namespace warren
