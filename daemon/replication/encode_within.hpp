// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/layer/replica.hpp"

namespace warren::replication {

// Replica::encode() for any limit: below kPacketBytesMin with as few blocks as it takes. Nothing
// also if the first block alone does not fit.
std::optional<DiffPacket> encode_within(const Replica& layer, EncodeRequest request);

}  // namespace warren::replication
