// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/layer/publishing_config.hpp"
#include "core/layer/replica.hpp"

namespace warren {

// What the diff-maps of a layer came to: each tick's changes once, as one broadcast would.
struct DiffTraffic {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
  std::uint64_t bytes_of_last_tick = 0;

  DiffTraffic& operator+=(const DiffTraffic& other) {
    packets += other.packets;
    bytes += other.bytes;
    bytes_of_last_tick += other.bytes_of_last_tick;
    return *this;
  }
};

// A layer that this node writes, with what it publishes at each tick. One thread.
class OwnLayer {
 public:
  OwnLayer(const LayerId& id, const PublishingConfig& config)
      : config_(config), layer_(id), publisher_(config.rules) {}

  // The exact codes of the blocks that changed since the last tick, none of them twice.
  void tick(std::span<const CodedBlock> changed);
  // Publishes what is held back.
  void flush();

  const Replica& layer() const { return layer_; }
  const DiffTraffic& traffic() const { return traffic_; }
  std::size_t blocks_held_back() const { return publisher_.blocks_held_back(); }

 private:
  void publish(std::span<const CodedBlock> blocks);

  PublishingConfig config_;
  Replica layer_;
  Publisher publisher_;
  DiffTraffic traffic_;
  std::uint32_t ticks_at_rest_ = 0;
};

}  // namespace warren
