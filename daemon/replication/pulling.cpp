// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/pulling.hpp"

#include <algorithm>
#include <utility>

#include "daemon/replication/encode_within.hpp"
#include "daemon/replication/holdings_walk.hpp"
#include "daemon/replication/near_keys.hpp"

namespace warren::replication {
namespace {

constexpr int kFruitlessMax = 3;
// What came before the provider heard of a gap is not a second one.
constexpr Duration kGapLeast = std::chrono::milliseconds(300);
// Around this node more is asked for than the radius, and anew when it has moved by half of that.
constexpr double kMargin = 0.25;

bool lacks_all_somewhere(const Holdings& holdings, const KeySet& keys) {
  return std::any_of(
      keys.intervals.begin(), keys.intervals.end(),
      [&](const KeyInterval& interval) { return holdings.lowest(interval) == Revision{}; });
}

Duration rtt_of(const Peer& peer) { return peer.link.rtt.value_or(Duration{}); }

}  // namespace

const HeldLayer* Pulling::on_announcement(Peer& from, Slot slot,
                                          std::span<const std::uint8_t> bytes) {
  auto announcement = read_announcement(bytes);
  if (!announcement) {
    ++node_.refused.malformed_announcements;
    return nullptr;
  }
  const auto known = from.announced.find(slot);
  const auto other = from.slots.find(announcement->layer);
  const bool changes =
      (known != from.announced.end() && known->second.layer != announcement->layer) ||
      (other != from.slots.end() && other->second != slot);
  if (changes) {
    ++node_.refused.changed_slots;
    return nullptr;
  }
  if (node_.config.share.share != Share::kNothing) {
    const Admission admission = node_.book.admit(announcement->layer, announcement->resolution);
    if (admission == Admission::kOtherResolution) ++node_.refused.other_resolution;
    if (admission != Admission::kKnown && admission != Admission::kAdmitted &&
        admission != Admission::kOwnLayer) {
      return nullptr;
    }
  }
  const HeldLayer* const layer = node_.book.find(announcement->layer);
  from.slots[announcement->layer] = slot;
  from.announced.insert_or_assign(slot, std::move(*announcement));
  choose_ = true;
  watch_at_ = std::min(watch_at_, node_.now + kWatchEvery);
  return layer;
}

HeldLayer* Pulling::on_diff(Peer& from, const DiffMessage& message) {
  const auto announced = from.announced.find(message.slot);
  HeldLayer* const layer =
      announced == from.announced.end() ? nullptr : node_.book.find(announced->second.layer);
  if (layer == nullptr) {
    ++node_.refused.unknown_slots;
    return nullptr;
  }
  from.map_heard = node_.now;
  const auto applied = node_.book.apply(node_.now, *layer, message.packet);
  if (applied.refused == Refusal::kNoRoom) choose_ = true;
  if (applied.refused) return layer;
  if (applied.result == ApplyResult::kApplied) {
    Pull& pull = pulls_[layer->slot];
    pull.progress = node_.now;
    pull.fruitless = 0;
  }
  if (applied.result == ApplyResult::kTooManyIntervals) make_room(*layer);
  const bool misses = applied.result == ApplyResult::kTooManyIntervals ||
                      (applied.claim && layer->replica().holdings().lowest(applied.claim->keys) <
                                            applied.claim->from);
  if (misses) {
    ++node_.refused.gaps;
    on_gap(*layer, from);
  }
  return layer;
}

// Who wants what is near gives up some of what it has left behind if a copy is in many pieces: in
// more than holdings may have, it takes no news.
void Pulling::leave_behind(HeldLayer& layer) {
  constexpr std::size_t kEnough = Holdings::kIntervalsMax * 3 / 4;
  for (const KeyInterval& keys : left_behind(layer.replica().holdings(), keys_of(layer))) {
    if (layer.replica().holdings().intervals().size() <= kEnough) return;
    node_.book.forget(node_.now, layer, keys);
  }
}

// If that is not enough the last pieces go, which a sweep brings last.
void Pulling::make_room(HeldLayer& layer) {
  constexpr std::size_t kAtMost = Holdings::kIntervalsMax - 2;  // a claim may need two more
  constexpr std::size_t kGiven = 8;
  leave_behind(layer);
  const auto pieces = layer.replica().holdings().intervals();
  if (pieces.size() <= kAtMost) return;
  node_.book.forget(node_.now, layer, {pieces[pieces.size() - kGiven].first, KeyInterval{}.end});
}

void Pulling::on_gap(const HeldLayer& layer, const Peer& provider) {
  Pull& pull = pulls_[layer.slot];
  if (pull.provider != provider.id) return;
  if (node_.now - pull.asked < kGapLeast + 2 * rtt_of(provider)) {
    watch_at_ = std::min(watch_at_, node_.now + kWatchEvery);
    return;
  }
  ask_again(layer);
}

void Pulling::ask_again(const HeldLayer& layer) {
  Pull& pull = pulls_[layer.slot];
  if (!pull.provider) return;
  ++node_.refused.wishes_for_lost;
  pull.lost = true;
  pull.asked = node_.now;
  tell(*pull.provider, layer.slot);
}

void Pulling::on_up(Peer& peer) {
  choose_ = true;
  for (auto& [slot, pull] : pulls_) {
    if (pull.provider == peer.id) pull.asked = node_.now;
  }
}

// It has forgotten what we want.
void Pulling::on_restarted(Peer& peer) {
  choose_ = true;
  for (auto& [slot, pull] : pulls_) {
    pull.idle_until.erase(peer.id);
    if (pull.provider == peer.id) pull.provider.reset();
  }
}

void Pulling::on_position(const Eigen::Vector3d& position_fleet) {
  if (node_.config.share.share != Share::kNear) return;
  const double reach = node_.config.share.radius_m * kMargin / 2.0;
  if (position_fleet_ && (position_fleet - *position_fleet_).norm() < reach) return;
  position_fleet_ = position_fleet;
  choose_ = true;
}

KeySet Pulling::keys_of(const HeldLayer& layer) const {
  if (node_.config.share.share == Share::kEverything) return {};
  KeySet keys;
  keys.intervals.clear();
  if (node_.config.share.share == Share::kNothing || !position_fleet_) return keys;
  const Replica& replica = layer.replica();
  return near_keys(replica.pose().T_fleet_layer().inverse() * *position_fleet_,
                   node_.config.share.radius_m * (1.0 + kMargin), replica.resolution().metres());
}

std::vector<Candidate> Pulling::candidates(const HeldLayer& layer, const Pull& pull) const {
  std::vector<Candidate> found;
  for (const auto& [id, peer] : node_.peers) {
    const Announcement* const announced = peer.up ? peer.find(layer.id) : nullptr;
    if (announced == nullptr) continue;
    const auto idle = pull.idle_until.find(id);
    found.push_back(
        {.member = id,
         .hops = announced->hops,
         .is_origin = id.number == layer.id.origin && announced->hops == 0,
         .gets_it_here = announced->provider == node_.config.self,
         .leads = holds_more(announced->holdings, layer.replica().holdings(), pull.keys),
         .is_partial = lacks_all_somewhere(announced->holdings, pull.keys),
         .highest = announced->holdings.highest({}).number,
         .rate_bit_s = peer.link.rate_bit_s,
         .loss = peer.link.loss_in,
         .is_idle = idle != pull.idle_until.end() && idle->second > node_.now,
         .is_current = pull.provider == id});
  }
  return found;
}

void Pulling::tell(MemberId member, Slot slot) {
  Peer* const peer = node_.find(member);
  if (peer == nullptr) return;
  peer->wishes_due.insert(slot);
  node_.commands.emplace_back(Wake{member});
}

void Pulling::choose(HeldLayer& layer) {
  Pull& pull = pulls_[layer.slot];
  KeySet keys = layer.full ? KeySet{{}} : keys_of(layer);
  const bool other_keys = keys != pull.keys;
  pull.keys = std::move(keys);
  if (other_keys && !pull.keys.is_everything()) leave_behind(layer);
  const Choice choice =
      pull.keys.intervals.empty() ? Choice{} : choose_provider(candidates(layer, pull));
  pull.hops = choice.hops;
  if (choice.provider == pull.provider && !other_keys) return;
  const auto before = std::exchange(pull.provider, choice.provider);
  if (before && before != choice.provider) tell(*before, layer.slot);
  if (!choice.provider) return;
  if (before != choice.provider) {
    pull.fruitless = 0;
    pull.asked = node_.now;
  }
  tell(*choice.provider, layer.slot);
}

void Pulling::choose_all() {
  choose_ = false;
  for (const auto& layer : node_.book.layers()) {
    if (layer->own == nullptr) choose(*layer);
  }
}

// The provider says that it has more, and it does not come.
void Pulling::watch(HeldLayer& layer, Pull& pull) {
  Peer* const provider = pull.provider ? node_.find(*pull.provider) : nullptr;
  const Announcement* const announced = provider == nullptr ? nullptr : provider->find(layer.id);
  if (announced == nullptr ||
      !holds_more(announced->holdings, layer.replica().holdings(), pull.keys)) {
    return;
  }
  watch_at_ = std::min(watch_at_, node_.now + kWatchEvery);
  const Timers& timers = node_.config.timers;
  const Duration idle = std::max(timers.idle_provider, 4 * rtt_of(*provider));
  const bool is_idle = node_.now >= std::max(provider->map_heard, pull.asked) + idle;
  const bool is_busy = node_.now >= std::max(pull.progress, pull.asked) + timers.busy_provider;
  if (!is_idle && !is_busy) return;
  if (++pull.fruitless > kFruitlessMax) {
    pull.idle_until[provider->id] = node_.now + timers.penalty;
    pull.fruitless = 0;
    choose(layer);
  }
  make_room(layer);
  ask_again(layer);
}

void Pulling::advance() {
  if (choose_) choose_all();
  if (node_.now < watch_at_) return;
  watch_at_ = kNever;
  for (auto& [slot, pull] : pulls_) watch(*node_.book.at(slot), pull);
}

MeshTime Pulling::next_deadline() const { return choose_ ? node_.now : watch_at_; }

Wish Pulling::wish_for(const Peer& to, const HeldLayer& layer, Slot theirs) {
  const Pull& pull = pulls_[layer.slot];
  Wish wish;
  wish.slot = theirs;
  wish.number = ++wishes_;
  wish.wanted = pull.provider == to.id;
  if (!wish.wanted) return wish;
  wish.lost = pull.lost;
  wish.holdings = layer.replica().holdings();
  wish.keys = pull.keys;
  return wish;
}

std::optional<mesh::MapSource::Packet> Pulling::next_for(Peer& to, std::size_t limit) {
  std::vector<std::uint8_t> message{WishMessage::kKind};
  WishesSent told;
  while (!to.wishes_due.empty()) {
    const Slot slot = *to.wishes_due.begin();
    const HeldLayer& layer = *node_.book.at(slot);
    const auto theirs = to.slots.find(layer.id);
    if (theirs != to.slots.end()) {
      const Wish wish = wish_for(to, layer, theirs->second);
      if (!append_within(message, wish, limit)) break;
      told.wishes.push_back({slot, wish.lost});
    }
    to.wishes_due.erase(to.wishes_due.begin());
  }
  if (told.wishes.empty()) return std::nullopt;
  const std::uint64_t ticket = node_.next_ticket++;
  to.sent[ticket] = std::move(told);
  to.traffic_out.other_bytes += message.size();
  return mesh::MapSource::Packet{ticket, mesh::MapClass::kFresh, std::move(message)};
}

void Pulling::on_acknowledged(const WishesSent& sent) {
  for (const WishesSent::Told& told : sent.wishes) {
    if (told.lost) pulls_[told.slot].lost = false;
  }
}

void Pulling::on_lost(Peer& peer, const WishesSent& sent) {
  for (const WishesSent::Told& told : sent.wishes) peer.wishes_due.insert(told.slot);
}

const Pull* Pulling::find(const HeldLayer& layer) const {
  const auto found = pulls_.find(layer.slot);
  return found == pulls_.end() ? nullptr : &found->second;
}

}  // namespace warren::replication
