// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "daemon/control/request.hpp"

namespace warren::control {
class BlocksRequest;
class RaysRequest;
}  // namespace warren::control

namespace warren {

// What planners ask for, from the message that brings it; or what is wrong with that.
tl::expected<ControlRequest, std::string> blocks_question(const control::BlocksRequest& request);
tl::expected<ControlRequest, std::string> rays_question(const control::RaysRequest& request);

}  // namespace warren
