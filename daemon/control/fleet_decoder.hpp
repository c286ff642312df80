// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "daemon/control/request.hpp"

namespace warren::control {
class Request;
}

namespace warren {

// Of a request whose body is one of fleet_request.hpp. The error says what is wrong with it.
tl::expected<ControlRequest, std::string> decode_fleet_request(const control::Request& request);

}  // namespace warren
