// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>

#include "daemon/replication/command.hpp"
#include "daemon/replication/config.hpp"
#include "daemon/replication/layer_book.hpp"
#include "daemon/replication/peer.hpp"

namespace warren::replication {

// Why something that came from a member was not used.
struct RefusedCounts {
  std::uint64_t malformed_announcements = 0;
  std::uint64_t changed_slots = 0;  // a slot that meant another layer before
  std::uint64_t malformed_messages = 0;
  std::uint64_t unknown_slots = 0;  // diffs of layers that are not announced yet
  std::uint64_t other_resolution = 0;
  std::uint64_t stale_wishes = 0;
  std::uint64_t gaps = 0;             // diffs since more than what is held
  std::uint64_t wishes_for_lost = 0;  // that we sent because of gaps and idle providers
  std::uint64_t peers_refused = 0;
};

// What the parts of replication share.
struct NodeState {
  static constexpr std::size_t kPeersMax = 256;

  explicit NodeState(const ReplicationConfig& node_config)
      : config(node_config), book(node_config.layers) {}

  // None if there are too many.
  Peer* find_or_add(MemberId member) {
    const auto found = peers.find(member);
    if (found != peers.end()) return &found->second;
    if (peers.size() >= kPeersMax) {
      ++refused.peers_refused;
      return nullptr;
    }
    Peer& added = peers[member];
    added.id = member;
    return &added;
  }
  Peer* find(MemberId member) {
    const auto found = peers.find(member);
    return found == peers.end() ? nullptr : &found->second;
  }

  ReplicationConfig config;
  MeshTime now{};
  LayerBook book;
  std::map<MemberId, Peer> peers;
  std::deque<Command> commands;
  RefusedCounts refused;
  std::uint64_t next_ticket = 1;
};

}  // namespace warren::replication
