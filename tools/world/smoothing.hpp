// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace warren::world {

// Convolves each column of values with a Gaussian; `sigma` counts in samples. The ends stay where
// they are: beyond them the values go on point-mirrored.
std::vector<double> smoothed(const std::vector<double>& values, double sigma);

}  // namespace warren::world
