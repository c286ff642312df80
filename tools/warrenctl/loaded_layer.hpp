// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace warren::control {
class LayerId;
}

namespace warren {

// The loaded layer that an operator means by a file's path or name, or by the beginning of an id;
// the error is a sentence for them: none is so called, or several are.
tl::expected<control::LayerId, std::string> find_loaded_layer(const std::string& socket,
                                                              const std::string& name);

}  // namespace warren
