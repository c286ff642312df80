// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/ray_command.hpp"

#include <iomanip>
#include <sstream>

#include "warren/control.pb.h"

namespace warren {

control::Request request_of(const RayCommand& command) {
  control::Request request;
  auto& rays = *request.mutable_rays();
  const auto& numbers = command.ray_map;
  rays.mutable_origins_map_m()->Assign(numbers.begin(), numbers.begin() + 3);
  rays.mutable_directions_map()->Assign(numbers.begin() + 3, numbers.end());
  rays.set_max_range_m(command.max_range_m);
  rays.set_through_unknown(command.through_unknown);
  rays.set_source(command.on_merge ? control::MERGE : control::SELF);
  return request;
}

std::string sentence_of(const control::Rays& rays) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(2);
  for (const auto& end : rays.ends()) {
    if (end.low_map_m_size() != 3) {
      out << "nothing within " << end.range_m() << " m\n";
      continue;
    }
    out << end.state() << " at " << end.range_m() << " m, the voxel from " << end.low_map_m(0)
        << ", " << end.low_map_m(1) << ", " << end.low_map_m(2) << " on";
    if (end.state() == "occupied") {
      out << ", cost ";
      end.has_cost() ? out << end.cost() : out << "no data";
    }
    out << (end.stair() ? ", stair\n" : "\n");
  }
  return out.str();
}

}  // namespace warren
