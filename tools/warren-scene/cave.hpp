// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace warren {

// A winding cave with a rough floor, boulders and a side chamber, as a signed distance field: below
// zero is air. The same seed gives the same cave.
class Cave {
 public:
  explicit Cave(std::uint32_t seed);

  // Metres to rock, from air; a bound that marching may step by.
  double distance_m(const Eigen::Vector3d& position) const;
  // Where the robot stands after so many metres: on the middle of the floor.
  Eigen::Vector3d floor_at(double along_m) const;
  double length_m() const { return 42.0; }

 private:
  struct Boulder {
    Eigen::Vector3d centre;
    double radius_m;
  };
  struct Bump {
    Eigen::Vector3d wave;  // rad/m
    double phase_rad;
    double height_m;
  };

  double middle_y(double x) const;
  double floor_z(double x) const;
  double roughness(const Eigen::Vector3d& position) const;

  std::vector<Boulder> boulders_;
  std::vector<Bump> bumps_;
};

}  // namespace warren
