// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/config/config.hpp"
#include "daemon/config/faults.hpp"

namespace YAML {
class Node;
}

namespace warren {

// Reads a parsed YAML document by the schema. What is wrong goes to `faults`; the result is to be
// used only if there are none.
Config read_document(const YAML::Node& root, FaultList& faults);

// Contradictions between values that are fine by themselves.
void check_consistency(const Config& config, FaultList& faults);

}  // namespace warren
