// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "transport/endpoint/beacon_clock.hpp"
#include "transport/endpoint/node.hpp"
#include "transport/endpoint/unconfirmed_boots.hpp"
#include "transport/wire/beacon.hpp"
#include "transport/wire/envelope.hpp"

namespace warren::mesh {

// Who is there: beacons out, beacons in, and the first packet to a boot that only its beacons have
// told of. Into silence nothing goes but beacons.
class Discovery {
 public:
  explicit Discovery(Node& node);

  // The peer that is concerned, if there is one.
  Peer* on_beacon(MeshTime now, const PacketHeader& header, const MeshPath& from,
                  std::span<const std::uint8_t> packet);
  // This boot is asked to prove that it lives.
  void challenge(MeshTime now, BootId boot, MemberId member, const MeshPath& from);
  // A pair packet of this boot has come.
  void on_confirmed(BootId boot) { unconfirmed_.forget(boot); }

  std::optional<Datagram> poll(MeshTime now);
  MeshTime next() const;
  std::size_t memory_bytes() const;

 private:
  Peer* on_session_beacon(MeshTime now, Peer& peer, const Beacon& beacon, const MeshPath& from);
  void on_unconfirmed_beacon(MeshTime now, const PacketHeader& header, const Beacon& beacon,
                             const MeshPath& from);
  static bool is_late(MeshTime now, Session& session, const Beacon& beacon);
  void greet(MeshTime now, const Beacon& beacon);
  void on_time(MeshTime now);
  bool misses_someone(MeshTime now) const;
  std::vector<Beacon::Heard> heard_in_turn(MeshTime now);
  std::size_t neighbours(MeshTime now) const;
  void send_round(MeshTime now);
  Datagram hello(const UnconfirmedBoots::Boot& boot);
  Duration answer_delay(MeshTime now);

  Node& node_;
  Key group_key_;
  BeaconClock clock_;
  UnconfirmedBoots unconfirmed_;
  std::deque<Datagram> round_;  // the rest of the beacons that are due
  std::uint64_t beacon_number_ = 0;
  MemberId heard_turn_;  // whom the last beacon told of last
};

}  // namespace warren::mesh
