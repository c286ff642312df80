// SPDX-License-Identifier: Apache-2.0
#include "tools/link/link_model.hpp"

#include <algorithm>
#include <cassert>

namespace warren {
namespace {

constexpr LinkNanoseconds kPerMicrosecond = 1000;

std::uint64_t& drops(LinkCounts& counts, ChannelLoss loss) {
  switch (loss) {
    case ChannelLoss::kBlackout:
      return counts.dropped_blackout;
    case ChannelLoss::kBurst:
      return counts.dropped_burst;
    case ChannelLoss::kPattern:
      return counts.dropped_pattern;
    default:
      return counts.dropped_loss;
  }
}

// The first microsecond that is not before `time`.
Duration microseconds(LinkNanoseconds time) {
  return Duration((time + kPerMicrosecond - 1) / kPerMicrosecond);
}

// Calls for every station that a packet is meant for.
template <typename F>
void for_each_receiver(const LinkPacket& packet, std::size_t stations, F&& call) {
  if (packet.to != kEveryStation) {
    call(packet.to);
    return;
  }
  for (std::size_t to = 0; to < stations; ++to) {
    if (to != packet.from) call(static_cast<StationIndex>(to));
  }
}

}  // namespace

bool LinkModel::Later::operator()(const Arrival& a, const Arrival& b) const {
  return std::pair(a.at, a.order) > std::pair(b.at, b.order);
}

LinkModel::LinkModel(const LinkModelConfig& config) : config_(config), stations_(config.stations) {
  assert(config.stations >= 2 && config.stations < kEveryStation);
  const world::Random random(config.seed);
  for (std::size_t from = 0; from < config.stations; ++from) {
    for (std::size_t to = 0; to < config.stations; ++to) {
      links_.push_back({config.link, Channel(random.fork(from).fork(to)), {}});
    }
  }
  airtimes_.resize(config.shared_airtime ? 1 : config.stations);
}

void LinkModel::set_link(MeshTime now, StationIndex from, StationIndex to,
                         const LinkConfig& config) {
  advance(since_start(now));
  link(from, to).config = config;
  Airtime& airtime = airtime_of(from);
  airtime.use.opportunity = 0;
  airtime.use.opportunity_bytes = 0;
  // What would have waited for ever begins anew.
  if (airtime.sender && airtime.use.at == kNeverPasses) begin_sending(airtime, now_);
  plan(from);
}

void LinkModel::set_silent(MeshTime now, bool silent) {
  advance(since_start(now));
  silent_ = silent;
}

void LinkModel::send(MeshTime now, LinkPacket packet) {
  assert(packet.from < stations_.size() && packet.to != packet.from);
  assert(packet.to < stations_.size() || packet.to == kEveryStation);
  advance(since_start(now));
  bool fits = true;
  for_each_receiver(packet, stations_.size(), [&](StationIndex to) {
    Link& out = link(packet.from, to);
    ++out.counts.offered_packets;
    out.counts.offered_bytes += packet.link_bytes;
    fits = fits && packet.link_bytes <= out.config.mtu_bytes;
  });
  const bool queued = fits && queue_has_room(packet);
  if (!queued) {
    for_each_receiver(packet, stations_.size(), [&](StationIndex to) {
      LinkCounts& counts = link(packet.from, to).counts;
      ++(fits ? counts.dropped_queue_full : counts.dropped_too_large);
    });
    return;
  }
  const StationIndex from = packet.from;
  stations_[from].queued_bytes += packet.link_bytes;
  stations_[from].planned = sent_by(packet, stations_[from].planned, now_);
  stations_[from].queue.push_back({std::move(packet), now_});
  if (!airtime_of(from).sender) begin_sending(airtime_of(from), now_);
}

std::optional<LinkDelivery> LinkModel::poll(MeshTime now) {
  advance(since_start(now));
  if (arrivals_.empty() || arrivals_.top().at > now_) return {};
  // A priority queue shows its top as constant; it is popped at once.
  Arrival arrival = std::move(const_cast<Arrival&>(arrivals_.top()));
  arrivals_.pop();
  LinkCounts& counts = link(arrival.delivery.from, arrival.delivery.to).counts;
  ++counts.delivered_packets;
  counts.delivered_bytes += arrival.link_bytes;
  return std::move(arrival.delivery);
}

MeshTime LinkModel::next_event() const {
  LinkNanoseconds next = arrivals_.empty() ? kNeverPasses : arrivals_.top().at;
  for (const Airtime& airtime : airtimes_) {
    if (airtime.sender) next = std::min(next, airtime.use.at);
  }
  return next == kNeverPasses ? kNever : config_.start + microseconds(next);
}

const LinkCounts& LinkModel::counts(StationIndex from, StationIndex to) const {
  return links_[from * stations_.size() + to].counts;
}

std::size_t LinkModel::queued_packets(StationIndex station) const {
  return stations_[station].queue.size();
}

LinkModel::Link& LinkModel::link(StationIndex from, StationIndex to) {
  return links_[from * stations_.size() + to];
}

LinkModel::Airtime& LinkModel::airtime_of(StationIndex station) {
  return airtimes_[config_.shared_airtime ? 0 : station];
}

const LinkModel::Airtime& LinkModel::airtime_of(StationIndex station) const {
  return airtimes_[config_.shared_airtime ? 0 : station];
}

// A free sender takes a packet whatever the limit.
bool LinkModel::queue_has_room(const LinkPacket& packet) {
  Station& station = stations_[packet.from];
  if (station.queue.empty()) return true;
  if (station.queue.size() >= config_.queue.packets) return false;
  if (station.queued_bytes + packet.link_bytes > config_.queue.bytes) return false;
  if (config_.queue.time == Duration::max()) return true;
  // Others' turns have moved the plan; without them it holds as it was made.
  if (config_.shared_airtime) plan(packet.from);
  return station.planned.at - now_ <= nanoseconds(config_.queue.time);
}

void LinkModel::plan(StationIndex index) {
  Station& station = stations_[index];
  const Airtime& airtime = airtime_of(index);
  const bool on_air = airtime.sender == index;
  station.planned = airtime.use;
  for (std::size_t i = on_air ? 1 : 0; i < station.queue.size(); ++i) {
    station.planned = sent_by(station.queue[i].packet, station.planned, now_);
  }
}

CapacityUse LinkModel::sent_by(const LinkPacket& packet, CapacityUse use,
                               LinkNanoseconds start) const {
  CapacityUse slowest{-1, 0, 0};
  for_each_receiver(packet, stations_.size(), [&](StationIndex to) {
    const LinkConfig& config = links_[packet.from * stations_.size() + to].config;
    const CapacityUse end = config.capacity.after(use, start, packet.link_bytes);
    if (end.at > slowest.at) slowest = end;
  });
  return slowest;
}

// In turn, beginning after the one who sent last.
std::optional<StationIndex> LinkModel::next_sender(const Airtime& airtime) const {
  if (!config_.shared_airtime) {
    const auto station = static_cast<StationIndex>(&airtime - airtimes_.data());
    return stations_[station].queue.empty() ? std::nullopt : std::optional(station);
  }
  for (std::size_t i = 1; i <= stations_.size(); ++i) {
    const std::size_t station = (airtime.last_sender + i) % stations_.size();
    if (!stations_[station].queue.empty()) return static_cast<StationIndex>(station);
  }
  return {};
}

void LinkModel::begin_sending(Airtime& airtime, LinkNanoseconds now) {
  airtime.sender = next_sender(airtime);
  if (!airtime.sender) return;
  if (airtime.use.at == kNeverPasses) airtime.use.at = now;
  Station& station = stations_[*airtime.sender];
  const Queued& first = station.queue.front();
  const LinkNanoseconds start = std::max(now, airtime.use.at);
  airtime.use = sent_by(first.packet, airtime.use, start);
  station.counts.queue_time_max =
      std::max(station.counts.queue_time_max, microseconds(start - first.since));
}

void LinkModel::finish_sending(Airtime& airtime) {
  const LinkNanoseconds sent_at = airtime.use.at;
  Station& station = stations_[*airtime.sender];
  airtime.last_sender = *airtime.sender;
  const LinkPacket packet = std::move(station.queue.front().packet);
  station.queue.pop_front();
  station.queued_bytes -= packet.link_bytes;
  ++station.counts.sent_packets;
  station.counts.sent_bytes += packet.link_bytes;
  for_each_receiver(packet, stations_.size(),
                    [&](StationIndex to) { arrive(packet, to, sent_at); });
  begin_sending(airtime, sent_at);
}

void LinkModel::arrive(const LinkPacket& packet, StationIndex to, LinkNanoseconds sent_at) {
  Link& in = link(packet.from, to);
  ChannelFate fate = in.channel.pass(in.config, sent_at);
  if (silent_) fate.lost = ChannelLoss::kBlackout;
  if (fate.lost != ChannelLoss::kNone) {
    ++drops(in.counts, fate.lost);
    return;
  }
  LinkDelivery delivery{.at = {},
                        .from = packet.from,
                        .to = to,
                        .group = packet.to == kEveryStation,
                        .corrupted = fate.flipped_bits > 0,
                        .duplicate = false,
                        .bytes = packet.bytes};
  if (delivery.corrupted) in.channel.flip_bits(delivery.bytes, fate.flipped_bits);
  in.counts.corrupted += delivery.corrupted ? 1 : 0;
  in.counts.reordered += fate.reordered ? 1 : 0;
  const auto add = [&](LinkNanoseconds at) {
    const Duration rounded = microseconds(at);
    delivery.at = config_.start + rounded;
    arrivals_.push({nanoseconds(rounded), arrivals_made_++, delivery, packet.link_bytes});
  };
  add(fate.arrives);
  if (!fate.arrives_again) return;
  ++in.counts.duplicated;
  delivery.duplicate = true;
  add(*fate.arrives_again);
}

void LinkModel::advance(LinkNanoseconds now) {
  assert(now >= now_);
  for (;;) {
    Airtime* next = nullptr;
    for (Airtime& airtime : airtimes_) {
      if (!airtime.sender || airtime.use.at > now) continue;
      if (next == nullptr || airtime.use.at < next->use.at) next = &airtime;
    }
    if (next == nullptr) break;
    finish_sending(*next);
  }
  now_ = now;
}

LinkNanoseconds LinkModel::since_start(MeshTime now) const {
  return nanoseconds(now - config_.start);
}

}  // namespace warren
