// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/group_serving.hpp"

#include <algorithm>
#include <utility>

#include "daemon/replication/encode_within.hpp"

namespace warren::replication {

// Those whose next run begins at the lowest key, and who hold about as much as the most advanced.
std::optional<GroupServing::Group> GroupServing::group_of(InterfaceIndex interface,
                                                          const HeldLayer& layer) const {
  if (!layer.may_be_told()) return std::nullopt;
  std::vector<std::pair<MemberId, Subscription::Run>> lacking;
  for (const auto& [id, peer] : node_.peers) {
    if (!peer.up || peer.interface != interface) continue;
    const auto found = peer.subscriptions.find(layer.slot);
    if (found == peer.subscriptions.end() || !found->second.has_room()) continue;
    if (const auto run = found->second.next_run(layer.replica())) lacking.emplace_back(id, *run);
  }
  if (lacking.size() < 2) return std::nullopt;
  BlockOrdinal first = kOrdinalEnd;
  for (const auto& [id, run] : lacking) first = std::min(first, run.keys.first);
  Revision newest;
  for (const auto& [id, run] : lacking) {
    if (run.keys.first == first) newest = std::max(newest, run.from);
  }
  Group group{{first, kOrdinalEnd}, newest, {}};
  for (const auto& [id, run] : lacking) {
    if (run.keys.first != first || run.from.number + kTogetherWithin < newest.number) continue;
    group.keys.end = std::min(group.keys.end, run.keys.end);
    group.from = std::min(group.from, run.from);
    group.members.push_back(id);
  }
  return group.members.size() < 2 ? std::nullopt : std::optional(std::move(group));
}

bool GroupServing::serves(const Peer& member, Slot slot) const {
  if (!enabled(member.interface)) return false;
  const auto group = group_of(member.interface, *node_.book.layers()[slot]);
  return group &&
         std::find(group->members.begin(), group->members.end(), member.id) != group->members.end();
}

std::optional<mesh::MapSource::Packet> GroupServing::next_for(InterfaceIndex interface,
                                                              std::size_t limit) {
  if (!enabled(interface) || limit <= kDiffOverhead) return std::nullopt;
  const auto& layers = node_.book.layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::size_t turn = (last_.value_or(0) + 1U + i) % layers.size();
    const HeldLayer& layer = *layers[turn];
    const auto group = group_of(interface, layer);
    if (!group) continue;
    const auto packet =
        encode_within(layer.replica(), {group->keys, group->from, limit - kDiffOverhead});
    if (!packet) continue;
    for (const MemberId id : group->members) {
      node_.peers.at(id).subscriptions.at(layer.slot).on_broadcast(packet->claim);
    }
    last_ = layer.slot;
    auto bytes = encode(DiffMessage{layer.slot, packet->bytes});
    bytes_ += bytes.size();
    return mesh::MapSource::Packet{node_.next_ticket++, mesh::MapClass::kFresh, std::move(bytes)};
  }
  return std::nullopt;
}

void GroupServing::wake(InterfaceIndex interface) const {
  if (enabled(interface)) node_.commands.emplace_back(WakeGroup{interface});
}

}  // namespace warren::replication
