// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Durations as numbers of seconds, for reckoning with rates.
inline double in_seconds(Duration duration) { return static_cast<double>(duration.count()) * 1e-6; }
inline Duration from_seconds(double value) { return Duration{std::llround(value * 1e6)}; }

}  // namespace warren::mesh
