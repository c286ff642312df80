// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace warren::world {

// Gradient noise (Perlin 2002: quintic fade) on a unit lattice whose gradients come from an integer
// hash: the same everywhere, no tables. About -1..1, zero on the lattice points.
double gradient_noise(const Eigen::Vector3d& position, std::uint64_t seed);

// `octaves` of it, each of double the frequency and half the height of the last; within -2..2.
double fractal_noise(const Eigen::Vector3d& position, int octaves, std::uint64_t seed);

}  // namespace warren::world
