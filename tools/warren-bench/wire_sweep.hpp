// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/layer/replica.hpp"

namespace warren {

// All packets for who holds `from` everywhere, in key order.
inline std::vector<DiffPacket> sweep(const Replica& source, Revision from,
                                     std::size_t packet_bytes) {
  std::vector<DiffPacket> packets;
  for_each_packet(source, {{}, from, packet_bytes}, [&](DiffPacket& packet) {
    packets.push_back(std::move(packet));
    return true;
  });
  return packets;
}

inline std::uint64_t bytes_of(const std::vector<DiffPacket>& packets) {
  std::uint64_t bytes = 0;
  for (const DiffPacket& packet : packets) bytes += packet.bytes.size();
  return bytes;
}

inline bool apply_all(Replica& copy, const std::vector<DiffPacket>& packets) {
  for (const DiffPacket& packet : packets) {
    if (copy.apply(copy.id(), packet.bytes) != ApplyResult::kApplied) return false;
  }
  return true;
}

// Every block of the source stands in the copy, and no other.
inline bool same_blocks(const Replica& source, const Replica& copy) {
  const auto contains_all = [](const Replica& of, const Replica& in) {
    bool same = true;
    of.for_each_changed({}, {}, [&](BlockOrdinal block, const LayerBlock& wanted) {
      const LayerBlock* const found = in.find(block);
      same = found == nullptr ? wanted.codes.empty() : found->codes == wanted.codes;
      return same;
    });
    return same;
  };
  return contains_all(source, copy) && contains_all(copy, source);
}

}  // namespace warren
