// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "core/voxel/scan.hpp"

namespace warren {

struct TimedScan {
  Scan scan;
  std::optional<double> time_s;  // when it was measured
};

// Where scans come from: a recording, or a simulation.
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  virtual std::size_t count() const = 0;
  // The next scan in order; nothing after the last.
  virtual tl::expected<std::optional<TimedScan>, std::string> next() = 0;
};

}  // namespace warren
