// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <queue>
#include <vector>

#include "tools/link/channel.hpp"
#include "tools/link/link_config.hpp"
#include "tools/link/link_counts.hpp"
#include "transport/mesh_time.hpp"

namespace warren {

using StationIndex = std::uint16_t;
inline constexpr StationIndex kEveryStation = UINT16_MAX;

struct LinkPacket {
  StationIndex from = 0;
  StationIndex to = kEveryStation;  // all but the sender, for one packet's airtime
  std::size_t link_bytes = 0;       // that take airtime: `bytes` and the headers that it left out
  std::vector<std::uint8_t> bytes;
};

struct LinkDelivery {
  MeshTime at;
  StationIndex from = 0;
  StationIndex to = 0;
  bool group = false;
  bool corrupted = false;  // bits of `bytes` are flipped
  bool duplicate = false;  // it has been delivered before
  std::vector<std::uint8_t> bytes;
};

struct LinkModelConfig {
  std::size_t stations = 2;
  // One sends at a time, in turn, packet by packet, as on one radio channel without collisions; or
  // each station has airtime of its own.
  bool shared_airtime = false;
  QueueLimit queue;  // of every station
  LinkConfig link;   // of every direction
  std::uint64_t seed = 1;
  MeshTime start{};  // what the times in LinkConfig count from
};

// Stations and the links between them, in virtual time: packets and time in, deliveries out. The
// same calls give the same deliveries. A station's packets wait in one queue; a group packet takes
// the airtime that its slowest receiver needs. Time must not go back.
class LinkModel {
 public:
  explicit LinkModel(const LinkModelConfig& config);

  // From now on; what is in the air stays. The direction's random sequences go on.
  void set_link(MeshTime now, StationIndex from, StationIndex to, const LinkConfig& config);
  // A blackout of all links without a schedule.
  void set_silent(MeshTime now, bool silent);

  void send(MeshTime now, LinkPacket packet);
  // What has arrived until now, oldest first; call until there is none.
  std::optional<LinkDelivery> poll(MeshTime now);
  // When poll() may have something without another send(). Not too late; sometimes too early.
  MeshTime next_event() const;

  std::size_t stations() const { return stations_.size(); }
  const LinkCounts& counts(StationIndex from, StationIndex to) const;
  const StationCounts& counts(StationIndex station) const { return stations_[station].counts; }
  std::size_t queued_packets(StationIndex station) const;
  std::size_t queued_bytes(StationIndex station) const { return stations_[station].queued_bytes; }

 private:
  struct Link {
    LinkConfig config;
    Channel channel;
    LinkCounts counts;
  };
  struct Queued {
    LinkPacket packet;
    LinkNanoseconds since = 0;
  };
  struct Station {
    std::deque<Queued> queue;  // the first one may be on the air
    std::size_t queued_bytes = 0;
    CapacityUse planned;  // when all of the queue has been sent, if nobody else sends
    StationCounts counts;
  };
  // What is sent one after the other: the whole medium, or one station.
  struct Airtime {
    CapacityUse use;
    std::optional<StationIndex> sender;  // on the air until use.at
    StationIndex last_sender = 0;
  };
  struct Arrival {
    LinkNanoseconds at = 0;
    std::uint64_t order = 0;
    LinkDelivery delivery;
    std::size_t link_bytes = 0;
  };
  struct Later {
    bool operator()(const Arrival& a, const Arrival& b) const;
  };

  Link& link(StationIndex from, StationIndex to);
  Airtime& airtime_of(StationIndex station);
  const Airtime& airtime_of(StationIndex station) const;
  bool is_on_air(StationIndex station) const;
  bool queue_has_room(const LinkPacket& packet);
  void plan(StationIndex station);
  CapacityUse sent_by(const LinkPacket& packet, CapacityUse use, LinkNanoseconds start) const;
  std::optional<StationIndex> next_sender(const Airtime& airtime) const;
  void begin_sending(Airtime& airtime, LinkNanoseconds now);
  void finish_sending(Airtime& airtime);
  void arrive(const LinkPacket& packet, StationIndex to, LinkNanoseconds sent_at);
  void advance(LinkNanoseconds now);
  LinkNanoseconds since_start(MeshTime now) const;

  LinkModelConfig config_;
  std::vector<Link> links_;  // by sender, then receiver
  std::vector<Station> stations_;
  std::vector<Airtime> airtimes_;
  std::priority_queue<Arrival, std::vector<Arrival>, Later> arrivals_;
  std::uint64_t arrivals_made_ = 0;
  LinkNanoseconds now_ = 0;
  bool silent_ = false;
};

}  // namespace warren
