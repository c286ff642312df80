// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "transport/endpoint/packet_size.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// Watches which of the latest packets on a path arrived, by their size alone.
class SizeWitness {
 public:
  static constexpr std::size_t kPacketsMax = 48;
  // So many later ones arrived: this one is lost.
  static constexpr std::uint64_t kOvertakenBy = 16;
  static constexpr Duration kWaitLeast = std::chrono::seconds(1);

  void on_sent(MeshTime now, std::uint64_t number, std::size_t ip_bytes);
  void on_ack(MeshTime now, const AckFrame& ack, PacketSize& size);
  // Packets that nothing was heard of for long.
  void on_time(MeshTime now, Duration rtt, PacketSize& size);

 private:
  struct Packet {
    std::uint64_t number = 0;
    std::size_t ip_bytes = 0;
    MeshTime sent;
  };
  std::deque<Packet> packets_;  // by number
};

}  // namespace warren::mesh
