// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "daemon/config/config.hpp"
#include "daemon/fleet/fleet.hpp"

namespace warren {

// What the fleet thread is to do by the config, with fresh random numbers for this life of the
// node. Reads the key file if there is a mesh; the error tells what to do.
tl::expected<FleetConfig, std::string> fleet_config_of(const Config& config);

}  // namespace warren
