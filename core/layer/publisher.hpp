// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/layer/replica.hpp"
#include "core/voxel/self_map.hpp"

namespace warren {

// The codes of one block of a self-map.
CodeBlock codes_of(const SelfMap& map, const BlockKey& key);

// What a tick has to publish: the blocks that changed in the map after the scan numbered `cursor`
// and whose codes differ from the published ones, for Replica::publish().
std::vector<PublishedBlock> changed_codes(const SelfMap& map, std::uint32_t cursor,
                                          const Replica& published);

}  // namespace warren
