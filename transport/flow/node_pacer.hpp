// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// When the next packet may go out on an interface, and to which peer. A packet to a peer costs the
// airtime bytes / pace of its link; all peers share the interface, and those that want to send get
// equal airtime (the one that got least so far goes first).
class NodePacer {
 public:
  using Peer = std::uint32_t;  // the owner's number for it
  // The name of packets that go to all: no member may have it.
  static constexpr Peer kGroup = UINT32_MAX;
  // What did not wait for its turn delays the others no longer than this.
  static constexpr Duration kAheadMax = std::chrono::milliseconds{250};

  // The ceiling is for all that the node sends there.
  explicit NodePacer(std::optional<double> ceiling_bit_s) : ceiling_(ceiling_bit_s) {}

  // Who wants to send a paced packet now. A peer that cannot (nothing to send, no room in flight)
  // should be unset, or it stalls nobody but itself.
  void want(Peer peer, bool wants);
  bool wants(Peer peer) const;
  // The peer is no more; what it owes is forgotten.
  void forget(Peer peer) { shares_.erase(peer); }

  // No packet before this; the past means at once.
  MeshTime ready_at() const { return ready_at_; }
  // The peer whose turn it is; nothing if it is too early or nobody wants.
  std::optional<Peer> next(MeshTime now);

  // Every packet of the node on this interface is told, whether it waited for its turn or not.
  // pace: Flow::pace() of the peer, IP bytes/s; of a group packet GroupRate's, of a beacon the
  // slowest's. True: the interface had no rest between the packet before and this one.
  bool on_sent(MeshTime now, std::optional<Peer> peer, std::size_t ip_bytes, double pace);

 private:
  struct Share {
    bool wants = false;
    Duration deficit{};  // airtime it got less than the others since it wants to send
  };
  static constexpr Duration kDeficitMax = std::chrono::seconds{1};
  void charge(Peer peer, Duration airtime);

  std::optional<double> ceiling_;
  std::map<Peer, Share> shares_;
  std::optional<Peer> turn_;
  MeshTime ready_at_{};
};

}  // namespace warren::mesh
