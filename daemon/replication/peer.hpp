// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/map_message.hpp"
#include "daemon/replication/subscription.hpp"
#include "transport/endpoint/endpoint.hpp"

namespace warren::replication {

// What a packet carried, until it is known what became of it.
struct DiffSent {
  Slot slot = 0;  // ours
};
struct WishesSent {
  struct Told {
    Slot slot = 0;      // ours
    bool lost = false;  // it said so
  };
  std::vector<Told> wishes;
};
struct LogWishesSent {
  std::vector<Slot> slots;  // ours, of logs
};
struct DigestSent {
  std::vector<std::uint8_t> bytes;
};
using Sent = std::variant<DiffSent, WishesSent, LogWishesSent, DigestSent>;

// Map bytes to and from one member.
struct MapTraffic {
  std::uint64_t fresh_bytes = 0;
  std::uint64_t backlog_bytes = 0;
  std::uint64_t other_bytes = 0;  // wishes, digests
};

// Another member, in its present boot.
struct Peer {
  // Packets whose fate is not known; more are forgotten, oldest first.
  static constexpr std::size_t kSentMax = 4096;

  MemberId id;
  bool up = false;
  InterfaceIndex interface = 0;
  mesh::LinkQuality link;
  MeshTime map_heard = MeshTime::min();

  // What it says it holds, by its slot; a slot never changes its layer.
  std::map<Slot, Announcement> announced;
  std::map<LayerId, Slot> slots;
  // What it wants from us, by our slot.
  std::map<Slot, Subscription> subscriptions;
  // What we have to tell it about what we want, by our slot.
  std::set<Slot> wishes_due;
  std::vector<std::vector<std::uint8_t>> digests_due;

  std::map<std::uint64_t, Sent> sent;  // by ticket
  std::optional<Slot> last_fresh;      // served last
  std::optional<Slot> last_backlog;
  MapTraffic traffic_out;
  MapTraffic traffic_in;

  const Announcement* find(const LayerId& layer) const {
    const auto slot = slots.find(layer);
    return slot == slots.end() ? nullptr : &announced.at(slot->second);
  }
};

}  // namespace warren::replication
