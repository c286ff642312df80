// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "tools/warren-replay/replay.hpp"

namespace warren {

// Shows how far a replay is: a bar that is redrawn on a terminal, a line now and then elsewhere.
class ProgressView {
 public:
  explicit ProgressView(std::FILE* out);

  void show(const ReplaySummary& summary);
  // The last state, whatever was shown before.
  void finish(const ReplaySummary& summary);

 private:
  void draw(const ReplaySummary& summary);

  std::FILE* out_;
  bool terminal_;
  std::chrono::steady_clock::time_point next_;
};

std::string to_text(const ReplaySummary& summary);
std::string to_json(const ReplaySummary& summary);

}  // namespace warren
