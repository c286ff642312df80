// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/warren-bench/transport_bench.hpp"

namespace warren {

struct TransportPrograms {
  std::filesystem::path bench;  // this one
  std::filesystem::path link;   // warren-link
};

// One transport, once, on a fresh link between two fresh namespaces.
TransportRun run_transport(const TransportOptions& options, const std::string& peer,
                           std::uint64_t seed, const TransportPrograms& programs);

}  // namespace warren
