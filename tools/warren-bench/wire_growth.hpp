// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/warren-bench/wire_tape.hpp"

namespace warren {

// CPU in a map of many copies of the scene over that in a map of one.
struct WireGrowth {
  double publish_share = 0.0;  // from the self-map to the layer's next revision
  double apply_share = 0.0;
};

WireGrowth bench_growth(const ScanSequence& sequence, const WireOptions& options);

}  // namespace warren
