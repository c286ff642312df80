// SPDX-License-Identifier: Apache-2.0
#include "tools/link/channel.hpp"

#include <algorithm>

namespace warren {
namespace {

constexpr std::uint32_t kFlippedBitsMax = 8;

const ChannelStep* step_at(const std::vector<ChannelStep>& steps, LinkNanoseconds time) {
  const auto next = std::upper_bound(
      steps.begin(), steps.end(), time,
      [](LinkNanoseconds t, const auto& step) { return t < nanoseconds(step.at); });
  return next == steps.begin() ? nullptr : &*(next - 1);
}

bool in_blackout(const std::vector<Blackout>& blackouts, LinkNanoseconds time) {
  const auto next = std::upper_bound(
      blackouts.begin(), blackouts.end(), time,
      [](LinkNanoseconds t, const Blackout& blackout) { return t < nanoseconds(blackout.from); });
  return next != blackouts.begin() && time < nanoseconds((next - 1)->until);
}

double loss_at(const LinkConfig& config, LinkNanoseconds time) {
  const ChannelStep* step = step_at(config.steps, time);
  return step != nullptr && step->loss ? *step->loss : config.loss;
}

}  // namespace

Channel::Channel(const world::Random& random)
    : loss_(random.fork(1)),
      burst_(random.fork(2)),
      jitter_(random.fork(3)),
      reorder_(random.fork(4)),
      duplicate_(random.fork(5)),
      corrupt_(random.fork(6)) {}

ChannelFate Channel::pass(const LinkConfig& config, LinkNanoseconds sent_at) {
  ChannelFate fate;
  // All draws are made for every packet, so that one loss does not shift another impairment.
  const bool lost = loss_.chance(loss_at(config, sent_at));
  const bool burst = config.burst_loss && in_burst(*config.burst_loss);
  const bool pattern = in_pattern(config.loss_pattern, sent_at);
  fate.reordered = reorder_.chance(config.reorder);
  const bool again = duplicate_.chance(config.duplicate);
  const bool corrupted = corrupt_.chance(config.corrupt);
  if (corrupted) fate.flipped_bits = static_cast<std::uint8_t>(1 + corrupt_.below(kFlippedBitsMax));

  fate.arrives = sent_at + delay(config, sent_at);
  if (!config.jitter_reorders) fate.arrives = std::max(fate.arrives, last_arrival_);
  if (in_blackout(config.blackouts, sent_at)) {
    fate.lost = ChannelLoss::kBlackout;
  } else if (lost) {
    fate.lost = ChannelLoss::kLoss;
  } else if (burst) {
    fate.lost = ChannelLoss::kBurst;
  } else if (pattern) {
    fate.lost = ChannelLoss::kPattern;
  }
  if (fate.lost != ChannelLoss::kNone) return fate;
  // A packet that is late on purpose does not hold up those behind it.
  if (!fate.reordered) last_arrival_ = fate.arrives;
  if (fate.reordered) fate.arrives += nanoseconds(config.reorder_by);
  if (again) fate.arrives_again = fate.arrives;
  return fate;
}

bool Channel::in_burst(const BurstLoss& burst) {
  const double leave = 1.0 / burst.mean_packets;
  const double enter = leave * burst.share / (1.0 - burst.share);
  burst_is_on_ = burst_is_on_ ? !burst_.chance(leave) : burst_.chance(enter);
  return burst_is_on_;
}

bool Channel::in_pattern(const LossPattern& pattern, LinkNanoseconds at) {
  if (pattern.lost.empty()) return false;
  if (pattern.slot > Duration{})
    pattern_position_ = static_cast<std::size_t>(at / nanoseconds(pattern.slot));
  return pattern.lost[pattern_position_++ % pattern.lost.size()];
}

LinkNanoseconds Channel::delay(const LinkConfig& config, LinkNanoseconds at) {
  const ChannelStep* step = step_at(config.steps, at);
  const LinkNanoseconds mean =
      nanoseconds(step != nullptr && step->delay ? *step->delay : config.delay);
  const auto jitter = static_cast<double>(nanoseconds(config.jitter));
  const auto moved = mean + static_cast<LinkNanoseconds>(jitter_.uniform(-jitter, jitter));
  return std::max<LinkNanoseconds>(0, moved);
}

void Channel::flip_bits(std::span<std::uint8_t> bytes, std::uint8_t bits) {
  if (bytes.empty()) return;
  for (std::uint8_t i = 0; i < bits; ++i) {
    const auto bit = corrupt_.below(8);
    bytes[corrupt_.below(static_cast<std::uint32_t>(bytes.size()))] ^=
        static_cast<std::uint8_t>(1U << bit);
  }
}

}  // namespace warren
