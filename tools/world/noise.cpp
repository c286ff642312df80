// SPDX-License-Identifier: Apache-2.0
#include "tools/world/noise.hpp"

#include <cmath>

namespace warren::world {
namespace {

std::uint32_t hash_of(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint64_t seed) {
  std::uint64_t h =
      seed + x * 0x9E3779B97F4A7C15ULL + y * 0xC2B2AE3D27D4EB4FULL + z * 0x165667B19E3779F9ULL;
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93ULL;
  return static_cast<std::uint32_t>((h ^ (h >> 32)) >> 7);
}

// The dot product of the offset with one of eight diagonals: the cheapest set without a preferred
// axis.
double slope(std::uint32_t hash, double x, double y, double z) {
  return ((hash & 1U) != 0 ? x : -x) + ((hash & 2U) != 0 ? y : -y) + ((hash & 4U) != 0 ? z : -z);
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double gradient_noise(const Eigen::Vector3d& position, std::uint64_t seed) {
  const double fx = std::floor(position.x());
  const double fy = std::floor(position.y());
  const double fz = std::floor(position.z());
  const auto ix = static_cast<std::uint32_t>(static_cast<std::int64_t>(fx));
  const auto iy = static_cast<std::uint32_t>(static_cast<std::int64_t>(fy));
  const auto iz = static_cast<std::uint32_t>(static_cast<std::int64_t>(fz));
  const double x = position.x() - fx;
  const double y = position.y() - fy;
  const double z = position.z() - fz;
  const auto at = [&](std::uint32_t dx, std::uint32_t dy, std::uint32_t dz) {
    return slope(hash_of(ix + dx, iy + dy, iz + dz, seed), x - dx, y - dy, z - dz);
  };
  const double u = fade(x);
  const double v = fade(y);
  const double low = mix(mix(at(0, 0, 0), at(1, 0, 0), u), mix(at(0, 1, 0), at(1, 1, 0), u), v);
  const double high = mix(mix(at(0, 0, 1), at(1, 0, 1), u), mix(at(0, 1, 1), at(1, 1, 1), u), v);
  return mix(low, high, fade(z));
}

double fractal_noise(const Eigen::Vector3d& position, int octaves, std::uint64_t seed) {
  double sum = 0.0;
  double height = 1.0;
  Eigen::Vector3d scaled = position;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += height * gradient_noise(scaled, seed + static_cast<std::uint64_t>(octave) * 0x5851F42DU);
    scaled *= 2.0;
    height *= 0.5;
  }
  return sum;
}

}  // namespace warren::world
