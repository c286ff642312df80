// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/subscription.hpp"

#include <algorithm>

#include "core/layer/catch_up.hpp"
#include "daemon/replication/encode_within.hpp"
#include "daemon/replication/holdings_walk.hpp"

namespace warren::replication {
namespace {

// While a sweep goes on the hot regions are looked for anew after so many revisions, if the
// member's holdings are not in pieces already.
constexpr std::uint32_t kPlanAgainAfter = 10;
constexpr std::size_t kPlanAgainIntervals = 24;

// What both have of a and b.
KeyInterval common(const KeyInterval& a, const KeyInterval& b) {
  return {std::max(a.first, b.first), std::min(a.end, b.end)};
}

std::uint32_t apart(Revision a, Revision b) {
  return a < b ? b.number - a.number : a.number - b.number;
}

}  // namespace

bool Subscription::on_wish(const Wish& wish, const Replica& layer) {
  if (wish.number <= wish_) return false;
  wish_ = wish.number;
  const bool is_new = !wanted_ && wish.wanted;
  wanted_ = wish.wanted;
  keys_ = wish.keys;
  parts_.clear();
  if (!wanted_ || is_new || wish.lost) {
    // What is on its way does not count any more, whatever becomes of it.
    packets_.clear();
    flying_ = 0;
    believed_ = wish.holdings;
  } else {
    believed_ = higher_of(believed_, wish.holdings);
  }
  assume_anew();
  if (is_new) {
    goal_ = {};
    if (layer.known_voxels() > kSmall_voxels) raise_goal(layer);
  }
  return true;
}

void Subscription::raise_goal(const Replica& layer) {
  const Revision highest = layer.holdings().highest({});
  if (highest <= goal_) return;
  goal_ = highest;
  parts_.clear();
}

std::optional<DiffPacket> Subscription::encode(const Replica& layer, const Run& run,
                                               std::size_t limit) const {
  auto packet = encode_within(layer, {run.keys, run.from, limit});
  if (!packet || assumed_.judge(packet->claim) != RaiseResult::kRaised) return std::nullopt;
  return packet;
}

// From the first swept key on that lacks something, as far as the next ones lack about the same.
std::optional<Subscription::Run> Subscription::fresh_run(const Replica& layer,
                                                         const KeyInterval& wanted) const {
  std::optional<Run> run;
  for_each_piece(wanted, believed_, assumed_,
                 [&](const KeyInterval& piece, Revision believed, Revision assumed) {
                   if (believed < goal_) return !run.has_value();
                   for_each_piece(piece, layer.holdings(), assumed_,
                                  [&](const KeyInterval& part, Revision ours, Revision) {
                                    const bool lacks = assumed < ours;
                                    if (!run && lacks) run = Run{part, believed};
                                    if (!run || run->keys == part) return true;
                                    if (!lacks || run->keys.end != part.first) return false;
                                    if (apart(run->from, believed) > kLevelWithin) return false;
                                    run->keys.end = part.end;
                                    run->from = std::min(run->from, believed);
                                    return true;
                                  });
                   return !run || run->keys.end == piece.end;
                 });
  return run;
}

std::optional<Subscription::Run> Subscription::backlog_run(const Replica& layer,
                                                           const KeyInterval& within) const {
  std::optional<Run> run;
  for_each_piece(within, believed_, assumed_,
                 [&](const KeyInterval& piece, Revision believed, Revision assumed) {
                   if (believed >= goal_) return !run.has_value();
                   if (run && (run->keys.end != piece.first || run->from != believed)) return false;
                   for_each_piece(piece, layer.holdings(), assumed_,
                                  [&](const KeyInterval& part, Revision ours, Revision) {
                                    if (assumed >= ours) return !run.has_value();
                                    if (!run) run = Run{part, believed};
                                    run->keys.end = part.end;
                                    return true;
                                  });
                   return !run || run->keys.end == piece.end;
                 });
  return run;
}

std::optional<DiffPacket> Subscription::next_fresh(const Replica& layer, std::size_t limit) const {
  if (!wanted_) return std::nullopt;
  for (const KeyInterval& wanted : keys_.intervals) {
    const auto run = fresh_run(layer, wanted);
    if (!run) continue;
    if (auto packet = encode(layer, *run, limit)) return packet;
  }
  return std::nullopt;
}

void Subscription::plan_parts(const Replica& layer) {
  const Revision highest = layer.holdings().highest({});
  const bool again = highest.number >= planned_at_.number + kPlanAgainAfter &&
                     believed_.intervals().size() <= kPlanAgainIntervals;
  if (!parts_.empty() && !again) return;
  planned_at_ = highest;
  // Where it lacks least, or the hottest region would always be one that it has.
  parts_ = catch_up_parts(layer, believed_.lowest({}));
  if (parts_.empty()) parts_.push_back({});
}

std::optional<DiffPacket> Subscription::next_backlog(const Replica& layer, std::size_t limit) {
  if (!wanted_) return std::nullopt;
  if (believed_.intervals().size() + flying_ >= kIntervalsAndPacketsMax) return std::nullopt;
  plan_parts(layer);
  for (const KeyInterval& part : parts_) {
    for (const KeyInterval& wanted : keys_.intervals) {
      const KeyInterval within = common(part, wanted);
      if (within.empty()) continue;
      const auto run = backlog_run(layer, within);
      if (!run) continue;
      if (auto packet = encode(layer, *run, limit)) return packet;
    }
  }
  return std::nullopt;
}

void Subscription::on_sent(std::uint64_t ticket, const Claim& claim) {
  packets_[ticket] = {claim, false};
  ++flying_;
  assumed_.raise(claim);
}

void Subscription::on_acknowledged(std::uint64_t ticket) {
  const auto found = packets_.find(ticket);
  if (found == packets_.end()) return;
  const Packet packet = found->second;
  packets_.erase(found);
  if (!packet.lost) --flying_;
  believed_.raise(packet.claim);
  if (packet.lost) assumed_.raise(packet.claim);
}

void Subscription::on_lost(std::uint64_t ticket) {
  const auto found = packets_.find(ticket);
  if (found == packets_.end() || found->second.lost) return;
  found->second.lost = true;
  --flying_;
  if (packets_.size() - flying_ > kLateMax) {
    packets_.erase(std::find_if(packets_.begin(), packets_.end(),
                                [](const auto& entry) { return entry.second.lost; }));
  }
  assume_anew();
}

void Subscription::on_broadcast(const Claim& claim) {
  believed_.raise(claim);
  assumed_.raise(claim);
}

void Subscription::assume_anew() {
  assumed_ = believed_;
  for (const auto& [ticket, packet] : packets_) {
    if (!packet.lost) assumed_.raise(packet.claim);
  }
}

}  // namespace warren::replication
