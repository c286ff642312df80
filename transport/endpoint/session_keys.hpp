// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "transport/endpoint/endpoint_counts.hpp"
#include "transport/mesh_id.hpp"
#include "transport/wire/envelope.hpp"
#include "transport/wire/key_schedule.hpp"
#include "transport/wire/replay_window.hpp"

namespace warren::mesh {

// What opens and seals the packets between this life of ours and one life of a peer. Each packet
// of the peer opens once.
class SessionKeys {
 public:
  using Content = std::vector<std::uint8_t>;

  // `first_number`: none from it on was used with this pair of boots.
  SessionKeys(const KeySchedule& keys, BootId self, BootId peer, std::uint64_t first_number);

  BootId peer() const { return peer_; }
  // Of the next packet that is sealed.
  std::uint64_t next_number() const { return next_number_; }
  // Whoever has received a number from this on has heard us since this session began.
  std::uint64_t first_number() const { return first_number_; }
  std::vector<std::uint8_t> seal(std::span<const std::uint8_t> content);
  // Precondition: header is the packet's, and its sender is the peer. Of beacons only the latest:
  // those of several interfaces may overtake each other a little.
  tl::expected<Content, Unused> open(const PacketHeader& header,
                                     std::span<const std::uint8_t> packet);
  // None with a higher number has been opened for this pair. Of a header just opened.
  bool is_newest_pair(const PacketHeader& header) const {
    return header.number + 1 == newest_pair_end_;
  }

 private:
  BootId self_;
  BootId peer_;
  Key sealing_;
  Key opening_;
  Key group_;
  std::uint64_t first_number_;
  std::uint64_t next_number_;
  std::uint64_t newest_pair_end_ = 0;
  std::uint64_t newest_beacon_end_ = 0;
  ReplayWindow pair_window_;
  ReplayWindow beacon_window_;
  ReplayWindow group_window_;
};

}  // namespace warren::mesh
