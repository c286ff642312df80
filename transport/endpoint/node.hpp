// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "transport/delivery/parcel_budget.hpp"
#include "transport/delivery/telemetry_board.hpp"
#include "transport/endpoint/endpoint.hpp"
#include "transport/endpoint/jitter.hpp"
#include "transport/endpoint/members.hpp"
#include "transport/flow/group_rate.hpp"
#include "transport/flow/node_pacer.hpp"

namespace warren::mesh {

// What the parts of an endpoint share.
struct Node {
  static constexpr Duration kForgetAfter = std::chrono::minutes(10);

  Node(const EndpointConfig& node_config, std::shared_ptr<const KeySchedule> key_schedule,
       MapSource& map_source);

  static bool can_be_member(MemberId id) { return id.number != NodePacer::kGroup; }
  // Whether it can be another one.
  bool can_be_peer(MemberId id) const { return id != config.self && can_be_member(id); }
  // The member, made known if it is not; none if there is no room for it, nor anybody to be
  // forgotten for it.
  Peer* find_or_add(MeshTime now, MemberId id);
  bool has_room_for(MeshTime now, MemberId id);
  // Who gives way if the table is full: the member not heard for longest, if that is longer than
  // kForgetAfter and it holds no parcels.
  Peer* forgettable(MeshTime now);
  // A pair packet proved this boot.
  void begin_session(MeshTime now, Peer& peer, BootId boot);
  // Tells everybody what became of what was sent.
  void settle(MeshTime now, Peer& peer, const Flow::Outcome& outcome);
  void note_liveness(MeshTime now, Peer& peer);
  void note_moved(MeshTime now, Peer& peer);

  void count(Unused reason) { ++counts[reason]; }
  void count_sent(std::size_t ip_bytes);
  std::size_t ip_bytes(InterfaceIndex interface, std::size_t packet_bytes) const {
    return config.interfaces[interface].ip_header_bytes + packet_bytes;
  }
  // What a datagram takes of the link.
  std::size_t link_bytes(const Datagram& datagram) const {
    const std::size_t copies =
        datagram.to.group ? config.interfaces[datagram.to.interface].group_copies : 1;
    return copies * ip_bytes(datagram.to.interface, datagram.bytes.size());
  }
  // Of those in reach there, IP bytes/s.
  struct Paces {
    double slowest = 0.0;
    double fastest = 0.0;
  };
  Paces paces(MeshTime now, InterfaceIndex interface) const;

  EndpointConfig config;
  std::shared_ptr<const KeySchedule> keys;
  MapSource& source;
  EndpointCounts counts;
  std::deque<MeshEvent> events;
  Jitter jitter;
  TelemetryBoard board;
  ParcelBudget sent_budget;
  ParcelBudget received_budget;
  Members members;
  std::vector<NodePacer> pacers;       // by interface
  std::vector<GroupRate> group_rates;  // likewise
  std::optional<MeshTime> started;     // the first time that something was sent, or could have been
  bool somebody_came_up = false;       // since Endpoint looked last
  // Above all numbers used with pairs of which there is no session: none is ever used twice.
  std::uint64_t free_pair_number = 0;
  // Likewise of urgent messages to members that were forgotten: they may know us still.
  std::uint32_t free_urgent_number = 0;
  // Who comes without a session may have been forgotten: it has to acknowledge a number that was
  // not used before the last forgetting, or what it sends may be recorded. None: nobody was.
  std::optional<std::uint64_t> fresh_from;
  // Of a peer that is about to be no more.
  std::function<void(Peer&)> on_forget;

 private:
  void forget(MeshTime now, Peer& peer);
};

}  // namespace warren::mesh
