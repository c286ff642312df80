// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "transport/delivery/inbox.hpp"
#include "transport/delivery/outbox.hpp"
#include "transport/delivery/scheduler.hpp"
#include "transport/endpoint/liveness.hpp"
#include "transport/endpoint/peer_paths.hpp"
#include "transport/endpoint/session_keys.hpp"
#include "transport/endpoint/size_witness.hpp"
#include "transport/flow/flow.hpp"
#include "transport/mesh_address.hpp"
#include "transport/mesh_id.hpp"

namespace warren::mesh {

// With one boot of a peer, from its first pair packet on; it outlives any silence.
struct Session {
  Session(const SessionKeys& session_keys, Flow session_flow)
      : keys(session_keys), flow(std::move(session_flow)) {}

  SessionKeys keys;
  Flow flow;
  MeshTime since;
  bool knows_us = false;  // it has our hello
  // When its boot began by the beacon taken last, on our clock.
  std::optional<MeshTime> booted;
  SizeWitness sizes;  // of packets on the current path
  // The first packet that wanted an acknowledgement since the peer was heard.
  std::optional<MeshTime> awaiting_since;
};

// One member of the fleet but ourselves, through all its restarts.
struct Peer {
  // A small packet that goes at a time of its own: the answer to a beacon, to a hello, a proof of
  // a path.
  struct Answer {
    MeshTime at;
    MeshPath path;
    bool wants_answer = false;
    int tries = 1;  // left; any sign that it was heard ends them
  };
  // Who asks, asks several times: a beacon that was heard is too good to be lost for a packet.
  static constexpr int kAskTries = 4;
  static constexpr int kReplyTries = 2;
  static constexpr Duration kTryAgain = std::chrono::milliseconds(100);
  static constexpr Duration kProofOfClock = std::chrono::seconds(5);
  static constexpr Duration kReplyLeast = std::chrono::milliseconds(20);

  Peer(MemberId member, const DeliveryConfig& delivery, std::uint64_t fresh_stream,
       std::uint32_t first_urgent, const TelemetryBoard& board, ParcelBudget& sent,
       ParcelBudget& received, std::size_t interfaces)
      : id(member),
        outbox(delivery, fresh_stream, board, sent, first_urgent),
        inbox(delivery, received),
        paths(interfaces) {}

  // Something of it was promised, or the layer above has not finished it.
  bool holds_parcels() const {
    return outbox.unfinished_bytes() > 0 || inbox.unfinished_parcels() > 0;
  }

  MemberId id;
  Outbox outbox;
  Inbox inbox;
  Scheduler scheduler;
  Liveness liveness;
  PeerPaths paths;
  std::optional<Session> session;
  std::optional<Answer> answer;
  MeshTime asked = MeshTime::min();           // because of a beacon that may be recorded
  MeshTime replied = MeshTime::min();         // to a hello
  std::optional<std::vector<Ticket>> repeat;  // what goes once more if nothing else does
  // Where it stands in the endpoint's order.
  MeshTime deadline = kNever;
  bool prompt = false;                    // has something that does not wait for its turn
  std::optional<InterfaceIndex> in_turn;  // wants a turn there

  // Nothing was heard for long though an answer was to be expected.
  bool is_silent(MeshTime now) const {
    if (!session || !session->awaiting_since) return false;
    const Duration rtt = session->flow.quality().rtt.value_or(Duration{});
    return now - *session->awaiting_since > std::max(kSilence, kSilenceRtts * rtt);
  }
  // Packets may go to it whenever there is something.
  bool in_reach(MeshTime now) const { return session && liveness.up() && !is_silent(now); }

  // Acknowledgements lost in a row can last seconds; the flow sends less and less meanwhile.
  static constexpr Duration kSilence = std::chrono::seconds(4);
  static constexpr int kSilenceRtts = 4;
};

}  // namespace warren::mesh
