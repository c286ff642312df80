// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "tools/warren-bench/cli.hpp"

namespace warren {

void add_options(CLI::App& app, PeersCommand& command);

}  // namespace warren
