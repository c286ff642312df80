// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/terrain/ground.hpp"
#include "daemon/control/request.hpp"

namespace warren {

struct GroundAnswer {
  GroundReport ground;
  Validity validity = Validity::kUnknown;
};

// Makes it a unit vector; false when it is no direction.
bool normalise(Eigen::Vector3d& gravity);

// `origin_map` is where the view's key (0, 0, 0) lies in the map frame, metres; `gravity_map` holds
// unless the question names its own. Or why there is no answer, in words for the client.
tl::expected<GroundAnswer, std::string> answer_ground(const TerrainView& view,
                                                      const Eigen::Vector3d& origin_map,
                                                      const Eigen::Vector3d& gravity_map,
                                                      const GroundQuestion& question);

}  // namespace warren
