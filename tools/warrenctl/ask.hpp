// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace warren::control {
class Request;
class Response;
}  // namespace warren::control

namespace warren {

// One request and its response; errors, the daemon's own included, are sentences for the operator.
tl::expected<control::Response, std::string> ask_daemon(const std::string& socket,
                                                        const control::Request& request);

}  // namespace warren
