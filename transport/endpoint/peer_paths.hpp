// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "transport/endpoint/packet_size.hpp"
#include "transport/mesh_address.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Where a peer can be reached: on each interface the address that its newest authentic pair packet
// came from, and which of them is used. Beacons, which can be recorded and replayed, only say how
// well an interface hears the peer.
class PeerPaths {
 public:
  // A path not heard for so long is used only if no other is better.
  static constexpr Duration kStaleLeast = std::chrono::milliseconds(2500);
  // A path must be better by so much, in units of loss, to take over.
  static constexpr double kBetterBy = 0.15;
  static constexpr Duration kProbeLeast = std::chrono::seconds(2);

  explicit PeerPaths(std::size_t interfaces) : paths_(interfaces) {}

  // A pair packet came, `newest` if none sent later has come. True: the current path has changed.
  bool on_pair_packet(MeshTime now, const MeshPath& from, bool newest);
  void on_beacon(MeshTime now, const MeshPath& from, Duration period);
  // What the flow says of the current path.
  void note_quality(double loss, Duration rtt);
  // True: another path is used from now on.
  bool choose(MeshTime now);
  // Whether a beacon from there should be followed by a small pair packet, so that its answer
  // proves the path. Noted as done.
  bool take_probe(MeshTime now, const MeshPath& from);
  // A new life: all must be proved again.
  void reset();

  std::optional<MeshPath> current() const;
  PacketSize& size() { return paths_[*current_].size; }
  const PacketSize& size() const { return paths_[*current_].size; }

 private:
  struct Path {
    std::optional<MeshAddress> address;  // proved
    MeshTime heard = MeshTime::min();
    MeshTime address_heard = MeshTime::min();
    MeshTime beacon = MeshTime::min();
    MeshTime probed = MeshTime::min();
    Duration period = std::chrono::seconds(1);
    double beacon_loss = 0.0;
    double loss = 0.0;
    Duration rtt{};
    PacketSize size;
  };
  static double cost(const Path& path, MeshTime now);

  std::vector<Path> paths_;  // by interface
  std::optional<InterfaceIndex> current_;
};

}  // namespace warren::mesh
