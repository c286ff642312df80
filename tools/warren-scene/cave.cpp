// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-scene/cave.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace warren {
namespace {

constexpr int kBumps = 10;
constexpr int kBoulders = 26;
constexpr double kChamberX = 24.0;

// std::uniform_real_distribution differs between libraries; this does not.
double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

double smooth_min(double a, double b, double blend_m) {
  const double h = std::clamp(0.5 + 0.5 * (b - a) / blend_m, 0.0, 1.0);
  return b + (a - b) * h - blend_m * h * (1.0 - h);
}

double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& centre,
                 const Eigen::Vector3d& radii) {
  const double scaled = (p - centre).cwiseQuotient(radii).norm();
  return (scaled - 1.0) * radii.minCoeff();
}

}  // namespace

Cave::Cave(std::uint32_t seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < kBumps; ++i) {
    const double wave = 1.2 * std::pow(1.45, i * 0.8);
    const Eigen::Vector3d direction(uniform(random, -1, 1), uniform(random, -1, 1),
                                    uniform(random, -1, 1));
    bumps_.push_back({direction.normalized() * wave, uniform(random, 0.0, 6.28), 0.16 / wave});
  }
  for (int i = 0; i < kBoulders; ++i) {
    const double x = uniform(random, 2.0, length_m());
    const double side = uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const double y = middle_y(x) + side * uniform(random, 1.0, 2.6);
    const double radius_m = uniform(random, 0.2, 0.75);
    boulders_.push_back({{x, y, floor_z(x) + 0.2 * radius_m}, radius_m});
  }
}

double Cave::middle_y(double x) const { return 3.0 * std::sin(x / 7.0); }
double Cave::floor_z(double x) const { return 1.2 * std::sin(x / 11.0); }

double Cave::roughness(const Eigen::Vector3d& position) const {
  double height = 0.0;
  for (const Bump& bump : bumps_) {
    height += bump.height_m * std::sin(bump.wave.dot(position) + bump.phase_rad);
  }
  return height;
}

double Cave::distance_m(const Eigen::Vector3d& p) const {
  const double floor = floor_z(p.x());
  // Passage: a squashed tube around the middle line, closed at both ends.
  const double y = p.y() - middle_y(p.x());
  const double z = p.z() - floor - 1.2;
  const double tube = (std::hypot(y / 2.9, z / 1.9) - 1.0) * 1.9;
  const double ends = std::max(-3.0 - p.x(), p.x() - length_m() - 3.0);
  const double chamber = ellipsoid(
      p, {kChamberX, middle_y(kChamberX) + 6.5, floor_z(kChamberX) + 1.6}, {5.0, 4.5, 2.9});
  const double opening = ellipsoid(
      p, {kChamberX, middle_y(kChamberX) + 2.8, floor_z(kChamberX) + 0.9}, {1.7, 2.2, 1.6});
  double air = std::max(tube, ends);
  air = smooth_min(air, opening, 0.4);
  air = smooth_min(air, chamber, 0.5);
  // A floor of debris cuts the tube's round bottom.
  air = std::max(air, floor - p.z());
  for (const Boulder& boulder : boulders_) {
    air = std::max(air, boulder.radius_m - (p - boulder.centre).norm());
  }
  return -(air + roughness(p));
}

Eigen::Vector3d Cave::floor_at(double along_m) const {
  return {along_m, middle_y(along_m), floor_z(along_m)};
}

}  // namespace warren
