// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "daemon/replication/group_serving.hpp"
#include "daemon/replication/node_state.hpp"

namespace warren::replication {

// The provider's side: gives each member what it wants of the layers held here, layer by layer in
// turn, the own ones first.
class Serving {
 public:
  explicit Serving(NodeState& node) : node_(node), group_(node) {}

  void on_wish(Peer& from, const Wish& wish);
  // The layer has news: whoever wants it is told.
  void on_news(const HeldLayer& layer);
  void on_up(Peer& peer);

  std::optional<mesh::MapSource::Packet> next_for(Peer& to, mesh::MapClass wanted,
                                                  std::size_t limit);
  std::optional<mesh::MapSource::Packet> next_for_group(InterfaceIndex interface,
                                                        std::size_t limit) {
    return group_.next_for(interface, limit);
  }
  std::uint64_t group_bytes() const { return group_.bytes(); }
  void on_acknowledged(Peer& peer, Slot slot, std::uint64_t ticket);
  void on_lost(Peer& peer, Slot slot, std::uint64_t ticket);

 private:
  std::optional<DiffPacket> next_of(Peer& to, Slot slot, mesh::MapClass wanted, std::size_t limit);

  NodeState& node_;
  GroupServing group_;
};

}  // namespace warren::replication
