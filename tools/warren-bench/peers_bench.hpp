// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/warren-bench/fleet_tape.hpp"

namespace warren {

struct PeersOptions {
  std::size_t robots = 5;
  double seconds = 60.0;
  std::vector<std::string> bases;  // "127.0.0.1:7718": who is to get all
  std::filesystem::path key_file;
  std::string interface = "lo";
  std::uint32_t port_base = 29300;  // two for each robot
  double settle_s = 120.0;          // at most so long for what is missing in the end
  FleetTapeOptions tape;
};

struct PeersResult {
  std::uint64_t ticks = 0;                  // of all robots
  std::uint64_t ticks_late = 0;             // begun when the next of that robot was due
  std::uint64_t voxels = 0;                 // known in what they published
  std::uint64_t bytes_sent = 0;             // IP, while they played
  double seconds = 0.0;                     // that they played
  double cores = 0.0;                       // of this process, meanwhile
  std::optional<double> caught_up_after_s;  // counted from the last tick
  std::size_t digests_equal = 0;            // robots of which all bases said so
};

// So many robots in one thread, each with a mesh of its own on real sockets. They meet nobody but
// the bases, copy nothing, and publish the same tape from different places on. Tells on stderr, a
// line each, when they are "ready" (all bases are met), and when all is "published".
tl::expected<PeersResult, std::string> bench_peers(const PeersOptions& options);

std::string to_text(const PeersResult& result);
std::string to_json(const PeersResult& result, const PeersOptions& options);

}  // namespace warren
