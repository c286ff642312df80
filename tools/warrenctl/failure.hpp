// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iostream>
#include <string>

namespace warren {

// Says why on stderr, and is the exit code.
inline int failure(const std::string& why, int code = 1) {
  std::cerr << "warrenctl: " << why << "\n";
  return code;
}

}  // namespace warren
