// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace warren::control {
class Rays;
class Request;
}  // namespace warren::control

namespace warren {

struct RayCommand {
  bool on_merge = false;
  std::array<double, 6> ray_map{};  // x y z of the origin, metres; and of the direction
  double max_range_m = 20.0;
  bool through_unknown = false;
  bool json = false;
};

control::Request request_of(const RayCommand& command);
// Of one ray: what stops it, where.
std::string sentence_of(const control::Rays& rays);

}  // namespace warren
