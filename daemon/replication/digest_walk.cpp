// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/digest_walk.hpp"

#include <algorithm>
#include <utility>

namespace warren::replication {
namespace {

// More regions than these are forgotten in one: holdings have few intervals.
constexpr std::size_t kForgottenMax = 8;

bool is_whole_at(const Holdings& holdings, Revision revision) {
  return holdings == Holdings(revision);
}

std::vector<DigestAnswer::Region> regions_within(const Replica& layer, RegionOrdinal first,
                                                 RegionOrdinal end) {
  std::vector<DigestAnswer::Region> regions;
  for (const LayerDigest::Entry& entry : layer.digest().regions()) {
    if (entry.ordinal >= first && entry.ordinal < end) {
      regions.push_back({entry.ordinal, prefix_of(entry.hash)});
    }
  }
  return regions;
}

// What is in one list only, or with another hash.
std::vector<RegionOrdinal> differing(const std::vector<DigestAnswer::Region>& ours,
                                     const std::vector<DigestAnswer::Region>& theirs) {
  std::map<RegionOrdinal, std::pair<std::optional<std::uint64_t>, std::optional<std::uint64_t>>>
      all;
  for (const auto& region : ours) all[region.region].first = region.hash;
  for (const auto& region : theirs) all[region.region].second = region.hash;
  std::vector<RegionOrdinal> different;
  for (const auto& [region, hashes] : all) {
    if (hashes.first != hashes.second) different.push_back(region);
  }
  return different;
}

}  // namespace

void DigestWalk::look(const HeldLayer& layer) {
  const Pull* const pull = layer.own != nullptr ? nullptr : pulling_.find(layer);
  Peer* const peer = pull == nullptr || !pull->provider ? nullptr : node_.find(*pull->provider);
  const Announcement* const said = peer == nullptr ? nullptr : peer->find(layer.id);
  if (said == nullptr || !said->digest || said->holdings != layer.replica().holdings()) return;
  if (*said->digest == prefix_of(layer.replica().digest().root())) return;
  Walk& walk = walks_[layer.slot];
  const Revision revision = said->holdings.at(0);
  if (walk.under_way && walk.revision == revision && walk.member == peer->id) return;
  WalkCounts& counts = counts_[layer.slot];
  counts.member = peer->id;
  ++counts.differences;
  const bool same = walk.revision == revision && walk.member == peer->id;
  const std::uint64_t repairs = same ? walk.repairs : 0;
  if (repairs >= kRepairsMax) {
    ++counts.given_up;
    return;
  }
  walk = {peer->id, revision, 0, {}, true, repairs};
  ask(*peer, peer->slots.at(layer.id), walk);
}

void DigestWalk::ask(Peer& peer, Slot theirs, const Walk& walk) {
  peer.digests_due.push_back(encode(DigestQuestion{theirs, walk.revision, walk.next}));
  node_.commands.emplace_back(Wake{peer.id});
}

void DigestWalk::on_question(Peer& from, const DigestQuestion& question) {
  const HeldLayer* const layer = node_.book.at(question.slot);
  if (layer == nullptr || !is_whole_at(layer->replica().holdings(), question.revision)) return;
  if (from.digests_due.size() >= kAnswersDueMax) return;
  constexpr std::size_t kAnswerBytes = 150;  // fits the smallest packets
  constexpr std::size_t kRegions =
      (kAnswerBytes - DigestAnswer::kOverheadMax) / DigestAnswer::kRegionBytesMax;
  DigestAnswer answer{question.slot, question.revision, question.first, kRegionEnd,
                      regions_within(layer->replica(), question.first, kRegionEnd)};
  if (answer.regions.size() > kRegions) {
    answer.end = answer.regions[kRegions].region;
    answer.regions.resize(kRegions);
  }
  from.digests_due.push_back(encode(answer));
  node_.commands.emplace_back(Wake{from.id});
}

void DigestWalk::on_answer(Peer& from, const DigestAnswer& answer) {
  const auto announced = from.announced.find(answer.slot);
  HeldLayer* const layer =
      announced == from.announced.end() ? nullptr : node_.book.find(announced->second.layer);
  const auto found = layer == nullptr ? walks_.end() : walks_.find(layer->slot);
  if (found == walks_.end()) return;
  Walk& walk = found->second;
  if (!walk.under_way || walk.member != from.id || walk.revision != answer.revision ||
      walk.next != answer.first) {
    return;
  }
  if (!is_whole_at(layer->replica().holdings(), walk.revision)) {
    walk.under_way = false;
    return;
  }
  const auto ours = regions_within(layer->replica(), answer.first, answer.end);
  for (const RegionOrdinal region : differing(ours, answer.regions)) {
    walk.differing.push_back(region);
  }
  walk.next = answer.end;
  if (walk.next < kRegionEnd) return ask(from, answer.slot, walk);
  repair(*layer, walk);
}

void DigestWalk::repair(HeldLayer& layer, Walk& walk) {
  walk.under_way = false;
  ++walk.repairs;
  counts_[layer.slot].regions += walk.differing.size();
  if (walk.differing.size() > kForgottenMax) {
    node_.book.forget(node_.now, layer, {});
  } else {
    for (const RegionOrdinal region : walk.differing) {
      node_.book.forget(node_.now, layer, keys_of_region(region));
    }
  }
  pulling_.ask_again(layer);
}

std::optional<mesh::MapSource::Packet> DigestWalk::next_for(Peer& to, std::size_t limit) {
  if (to.digests_due.empty() || to.digests_due.front().size() > limit) return std::nullopt;
  auto bytes = std::move(to.digests_due.front());
  to.digests_due.erase(to.digests_due.begin());
  const std::uint64_t ticket = node_.next_ticket++;
  to.sent[ticket] = DigestSent{bytes};
  to.traffic_out.other_bytes += bytes.size();
  return mesh::MapSource::Packet{ticket, mesh::MapClass::kFresh, std::move(bytes)};
}

void DigestWalk::on_lost(Peer& peer, const DigestSent& sent) {
  if (peer.digests_due.size() < kAnswersDueMax) peer.digests_due.push_back(sent.bytes);
}

WalkCounts DigestWalk::counts_of(Slot slot) const {
  const auto found = counts_.find(slot);
  return found == counts_.end() ? WalkCounts{} : found->second;
}

}  // namespace warren::replication
