// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/layer/replica.hpp"
#include "daemon/replication/map_message.hpp"

namespace warren::replication {

// Replica::encode() for any limit: below kPacketBytesMin with as few blocks as it takes. Nothing
// also if the first block alone does not fit.
std::optional<DiffPacket> encode_within(const Replica& layer, EncodeRequest request);

// Appends to a message that begins with WishMessage::kKind, if that stays within the limit. Alone
// in it a wish may say less of what is held, so that it fits.
bool append_within(std::vector<std::uint8_t>& message, Wish wish, std::size_t limit);

}  // namespace warren::replication
