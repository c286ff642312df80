// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/encode_within.hpp"

#include <algorithm>
#include <vector>

namespace warren::replication {

std::optional<DiffPacket> encode_within(const Replica& layer, EncodeRequest request) {
  const std::size_t limit = request.limit_bytes;
  request.limit_bytes = std::max(limit, kPacketBytesMin);
  auto packet = layer.encode(request);
  while (packet && packet->bytes.size() > limit) {
    std::vector<BlockOrdinal> told;
    layer.for_each_changed(packet->claim.keys, request.from, [&](BlockOrdinal block, const auto&) {
      told.push_back(block);
      return true;
    });
    if (told.size() < 2) return std::nullopt;
    const std::size_t fitting = told.size() * limit / packet->bytes.size();
    request.keys.end = told[std::clamp<std::size_t>(fitting, 1, told.size() - 1)];
    packet = layer.encode(request);
  }
  return packet;
}

}  // namespace warren::replication
