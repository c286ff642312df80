// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "transport/endpoint/discovery.hpp"
#include "transport/endpoint/node.hpp"

namespace warren::mesh {

// What comes in: to whom it belongs, whether it is authentic and new, and what it says.
class Reception {
 public:
  Reception(Node& node, Discovery& discovery) : node_(node), discovery_(discovery) {}

  // The peer that is concerned, if there is one.
  Peer* on_datagram(MeshTime now, const MeshPath& from, std::span<const std::uint8_t> bytes);

 private:
  Peer* on_pair_packet(MeshTime now, const PacketHeader& header, const MeshPath& from,
                       std::span<const std::uint8_t> packet);
  Peer* on_group_packet(const PacketHeader& header, std::span<const std::uint8_t> packet);
  Peer* on_first_packet(MeshTime now, const PacketHeader& header, const MeshPath& from,
                        std::span<const std::uint8_t> packet);
  void on_frame(MeshTime now, Peer& peer, const MeshPath& from, Frame&& frame);
  static void reply(MeshTime now, Peer& peer, const MeshPath& from);
  void on_acknowledgement(MeshTime now, Peer& peer, const AckFrame& ack);
  void hand_on(MemberId from, Received&& received);
  void relieve_memory();

  Node& node_;
  Discovery& discovery_;
  std::uint64_t refused_seen_ = 0;  // of the budget for what is received
};

}  // namespace warren::mesh
