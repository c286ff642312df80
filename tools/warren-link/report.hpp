// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/warren-link/emulator.hpp"
#include "tools/warren-link/namespaces.hpp"

namespace warren {

// One JSON object in one line: what every node sent, what became of it in every direction that was
// used, and how late the emulator itself was.
std::string to_json(const Emulator& emulator, const Namespaces& namespaces, Duration ran);

}  // namespace warren
