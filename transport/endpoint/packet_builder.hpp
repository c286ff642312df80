// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/endpoint/node.hpp"

namespace warren::mesh {

// What may go into a packet beside acknowledgements and what is urgent.
enum class PacketFill : std::uint8_t { kUrgentOnly, kEverything };

// The next packet to the peer, told to its flow and its interface's pacer; nothing if there is
// nothing to say. Precondition: a session, and a path or an answer that is due.
std::optional<Datagram> build_packet(Node& node, MeshTime now, Peer& peer, PacketFill fill);

// What the scheduler wants to know of the path.
SendState send_state(const Node& node, MeshTime now, const Peer& peer);

}  // namespace warren::mesh
