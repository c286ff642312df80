// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "transport/wire/beacon.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh::test {

using Random = std::mt19937_64;

// Of any magnitude alike, at most `max`.
std::uint64_t any_up_to(Random& random, std::uint64_t max);
std::vector<std::uint8_t> random_bytes(Random& random, std::size_t size);

// Any frame that may be encoded, of each kind alike; and one that need not be the last.
Frame random_frame(Random& random);
Frame random_inner_frame(Random& random);
Beacon random_beacon(Random& random);

}  // namespace warren::mesh::test
