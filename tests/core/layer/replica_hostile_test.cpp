// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "core/layer/replica.hpp"
#include "tests/core/layer/replica_steps.hpp"

using namespace warren;
using namespace warren::test;

TEST_CASE("what is not a packet of this layer and version changes nothing") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free())});
  DiffPacket packet = encoded(origin, 0);
  Replica copy(kLayer, kDefaultResolution);
  LayerId other = kLayer;
  ++other.incarnation;
  CHECK(copy.apply(other, packet.bytes) == ApplyResult::kOtherLayer);
  packet.bytes[0] = kPacketVersion + 1;
  CHECK(apply(copy, packet) == ApplyResult::kUnknownVersion);
  packet.bytes[0] = kPacketVersion;
  packet.bytes.pop_back();
  CHECK(apply(copy, packet) == ApplyResult::kMalformed);
  CHECK(copy.find(9) == nullptr);
  CHECK(copy.holdings() == Holdings());
}

TEST_CASE("a malformed end undoes nothing, because nothing was done") {
  const Replica origin = noisy_layer(20);
  const auto packets = encode_all(origin, {}, 1400);
  Replica copy(kLayer, kDefaultResolution);
  for (DiffPacket packet : packets) {
    packet.bytes.back() = static_cast<std::uint8_t>(packet.bytes.back() ^ 1);
    packet.bytes.push_back(0);
    CHECK(apply(copy, packet) == ApplyResult::kMalformed);
  }
  CHECK(copy.holdings() == Holdings());
  std::size_t blocks = 0;
  copy.for_each_changed({}, {}, [&](BlockOrdinal, const LayerBlock&) { return ++blocks > 0; });
  CHECK(blocks == 0);
}

TEST_CASE("a replica survives packets with any bit flipped, one after the other") {
  const Replica origin = noisy_layer(3);
  DiffPacket packet = encoded(origin, 0);
  Replica copy(kLayer, kDefaultResolution);
  for (std::size_t bit = 0; bit < packet.bytes.size() * 8; ++bit) {
    auto& byte = packet.bytes[bit / 8];
    byte = static_cast<std::uint8_t>(byte ^ 1U << bit % 8);
    apply(copy, packet);
    byte = static_cast<std::uint8_t>(byte ^ 1U << bit % 8);
    CHECK(copy.holdings().intervals().size() <= Holdings::kIntervalsMax);
    if (bit % 50 == 0) copy = Replica(kLayer, kDefaultResolution);
  }
}

TEST_CASE("a packet of a later version is refused and counted") {
  Replica origin(kLayer, kDefaultResolution);
  publish(origin, {block_with(9, 1, VoxelCode::free())});
  DiffPacket packet = encoded(origin, 0);
  ++packet.bytes[0];
  Replica copy(kLayer, kDefaultResolution);
  for (int i = 0; i < 3; ++i) apply(copy, packet);
  const auto index = static_cast<std::size_t>(ApplyResult::kUnknownVersion);
  CHECK(copy.apply_counts()[index] == 3);
  CHECK(copy.digest().root() == Replica(kLayer, kDefaultResolution).digest().root());
}
