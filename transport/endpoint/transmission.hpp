// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "transport/endpoint/node.hpp"

namespace warren::mesh {

// What goes to the peers and when: who has something that may not wait, whose turn it is, what each
// of them waits for. Work per packet grows with the logarithm of the number of peers.
class Transmission {
 public:
  explicit Transmission(Node& node);

  // Something about the peer has changed.
  void refresh(MeshTime now, Peer& peer, bool serviced = false);
  void wake_group(InterfaceIndex interface);
  // The peer is about to be no more.
  void forget(Peer& peer);

  std::optional<Datagram> poll(MeshTime now);
  MeshTime next(MeshTime now) const;

 private:
  void service(MeshTime now, Peer& peer);
  void set_deadline(Peer& peer, MeshTime deadline);
  void set_prompt(Peer& peer, bool prompt);
  void set_turn(Peer& peer, std::optional<InterfaceIndex> interface);
  // due: when the peer's classes have something to send.
  static MeshTime deadline_of(MeshTime now, const Peer& peer, MeshTime due, bool serviced);
  bool wants_turn(MeshTime now, Peer& peer, MeshTime due);
  std::optional<Datagram> poll_prompt(MeshTime now);
  std::optional<Datagram> poll_turn(MeshTime now, InterfaceIndex interface);
  std::optional<Datagram> group_packet(MeshTime now, InterfaceIndex interface);

  Node& node_;
  Key group_key_;
  std::uint64_t group_number_ = 0;
  std::set<std::pair<MeshTime, MemberId>> deadlines_;
  std::set<MemberId> prompt_;
  std::vector<std::size_t> turns_wanted_;  // by interface
  std::vector<bool> group_awake_;          // by interface
  std::vector<bool> group_alone_;          // would be awake, but nobody is in reach
};

}  // namespace warren::mesh
