// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/replica.hpp"
#include "tests/core/layer/random_codes.hpp"

// What tests of replicas do again and again.
namespace warren::test {

inline constexpr LayerId kLayer{7, 1, 0x1234};

inline CodedBlock block_with(BlockOrdinal block, std::uint32_t place, VoxelCode code) {
  BlockCodes codes;
  codes.set(place, code);
  return {block, CodeBlock(codes)};
}

inline void publish(Replica& origin, const std::vector<CodedBlock>& blocks) {
  const Revision before = origin.holdings().at(0);
  REQUIRE(origin.publish(blocks).number == before.number + 1);
}

inline DiffPacket encoded(const Replica& sender, std::uint32_t from, KeyInterval keys = {}) {
  const auto packet = sender.encode({keys, {from}});
  REQUIRE(packet);
  return *packet;
}

inline std::vector<DiffPacket> encode_all(const Replica& sender, Revision from,
                                          std::size_t limit_bytes) {
  std::vector<DiffPacket> packets;
  for_each_packet(sender, {{}, from, limit_bytes}, [&](DiffPacket& packet) {
    packets.push_back(std::move(packet));
    return true;
  });
  return packets;
}

inline ApplyResult apply(Replica& receiver, const DiffPacket& packet) {
  return receiver.apply(kLayer, packet.bytes);
}

inline bool same(const Replica& a, const Replica& b, BlockOrdinal block) {
  return a.codes(block) == b.codes(block);
}

// A layer with so many blocks of noise.
inline Replica noisy_layer(std::size_t blocks) {
  Random random(1);
  std::vector<CodedBlock> changes;
  for (std::size_t i = 0; i < blocks; ++i) {
    changes.push_back({random() % kOrdinalEnd, CodeBlock(random_codes(random))});
  }
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, changes);
  return origin;
}

}  // namespace warren::test
