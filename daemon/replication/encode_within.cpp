// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/encode_within.hpp"

#include <algorithm>
#include <vector>

#include "daemon/replication/holdings_walk.hpp"

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

bool append_within(std::vector<std::uint8_t>& message, Wish wish, std::size_t limit) {
  const std::size_t before = message.size();
  for (std::size_t intervals = Holdings::kIntervalsMax; intervals > 0; intervals /= 2) {
    append(message, wish);
    if (message.size() <= limit) return true;
    message.resize(before);
    if (before > 1) return false;
    wish.holdings = coarsened(wish.holdings, intervals);
  }
  return false;
}

}  // namespace warren::replication
