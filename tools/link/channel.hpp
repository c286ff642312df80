// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/link/link_config.hpp"
#include "tools/world/random.hpp"

namespace warren {

enum class ChannelLoss : std::uint8_t { kNone, kBlackout, kLoss, kBurst, kPattern };

// What becomes of one packet in the air.
struct ChannelFate {
  ChannelLoss lost = ChannelLoss::kNone;
  LinkNanoseconds arrives = 0;
  std::optional<LinkNanoseconds> arrives_again;
  bool reordered = false;
  std::uint8_t flipped_bits = 0;
};

// One direction's random part. Each impairment draws from a sequence of its own: switching one on
// does not change what another does.
class Channel {
 public:
  explicit Channel(const world::Random& random);

  // Precondition: calls in the order of sending.
  ChannelFate pass(const LinkConfig& config, LinkNanoseconds sent_at);
  void flip_bits(std::span<std::uint8_t> bytes, std::uint8_t bits);

 private:
  bool in_burst(const BurstLoss& burst);
  bool in_pattern(const LossPattern& pattern, LinkNanoseconds at);
  LinkNanoseconds delay(const LinkConfig& config, LinkNanoseconds at);

  world::Random loss_, burst_, jitter_, reorder_, duplicate_, corrupt_;
  bool burst_is_on_ = false;
  std::size_t pattern_position_ = 0;
  LinkNanoseconds last_arrival_ = 0;
};

}  // namespace warren
