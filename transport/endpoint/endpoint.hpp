// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "transport/endpoint/endpoint_counts.hpp"
#include "transport/flow/link_quality.hpp"
#include "transport/mesh_address.hpp"
#include "transport/mesh_id.hpp"
#include "transport/mesh_time.hpp"
#include "transport/wire/frames.hpp"
#include "transport/wire/key_schedule.hpp"

namespace warren::mesh {

struct InterfaceConfig {
  // Precondition: no MTU is smaller. Answers about parcels would not fit.
  static constexpr std::size_t kMtuLeast = 300;

  std::size_t mtu_bytes = 1428;         // of an IP packet, headers included
  std::size_t ip_header_bytes = 28;     // IP and UDP: 28, or 48 with IPv6
  std::optional<double> ceiling_bit_s;  // of all that this node sends there, IP bytes
  std::size_t group_copies = 1;         // datagrams that the shell sends for one to the group
  bool group_broadcast = false;         // ask MapSource for packets that all can hear
  std::vector<MeshAddress> seeds;       // beacons go there too, besides the group
};

struct EndpointConfig {
  MemberId self;
  BootId boot;  // 64 fresh random bits
  std::uint64_t random_seed = 0;
  std::vector<InterfaceConfig> interfaces;
  // Others that are known. When full, a new one takes the place of the one not heard for longest
  // (10 minutes at least) with which no parcel is unfinished.
  std::size_t members_max = 256;
  std::size_t parcels_bytes_max = 64'000'000;  // of all unfinished ones, sent and received
};

struct Member {
  MemberId id;
  BootId boot;
  MeshPath path;   // where packets go now
  MeshTime since;  // first heard in this boot
  MeshTime last_heard;
  bool up = false;  // heard lately, and hears us
  LinkQuality link;
};

// Events, oldest first.
struct MemberUp {
  MemberId member;
};
struct MemberDown {
  MemberId member;
};  // silent; its session lives on
struct MemberRestarted {
  MemberId member;
};
// The table of members was full, and it was the one not heard for longest.
struct MemberForgotten {
  MemberId member;
};
struct MemberMoved {
  MemberId member;
  MeshPath path;
};
struct UrgentArrived {
  MemberId from;
  std::vector<std::uint8_t> bytes;
};
struct TelemetryArrived {
  MemberId from;
  std::uint16_t key;
  std::vector<std::uint8_t> bytes;
};
// Once per parcel. It counts as handed over when finish_parcel() is called: until then a restart
// delivers it again.
struct ParcelArrived {
  MemberId from;
  ParcelKey key;
  ParcelClass priority;
  std::vector<std::uint8_t> bytes;
};
struct ParcelDelivered {
  MemberId to;
  ParcelKey key;
};  // handed over at the other side
struct MapArrived {
  MemberId from;
  MapClass priority;
  std::vector<std::uint8_t> bytes;
};
using MeshEvent =
    std::variant<MemberUp, MemberDown, MemberRestarted, MemberForgotten, MemberMoved, UrgentArrived,
                 TelemetryArrived, ParcelArrived, ParcelDelivered, MapArrived>;

// The layer above, asked for map packets when there is room to send one. It is told of each what
// became of it, in any order; one told lost may be told acknowledged later: it was only late.
class MapSource {
 public:
  struct Packet {
    std::uint64_t ticket = 0;
    MapClass priority = MapClass::kBacklog;
    std::vector<std::uint8_t> bytes;  // at most the limit asked for
  };
  virtual ~MapSource() = default;
  // It is asked for no packet with a lower limit than this: a path that carries less carries none.
  // Constant.
  virtual std::size_t bytes_min() const { return 1; }
  // A packet of exactly this class. Nothing: nothing of it to send there until Endpoint::wake().
  virtual std::optional<Packet> next_for(MemberId to, MapClass wanted, std::size_t limit) = 0;
  // For all who hear this interface; nobody acknowledges those.
  virtual std::optional<Packet> next_for_group(InterfaceIndex, std::size_t) { return {}; }
  virtual void on_acknowledged(MemberId, std::uint64_t ticket) = 0;
  virtual void on_lost(MemberId, std::uint64_t ticket) = 0;
};

enum class SendError { kTooLarge, kFull, kUnknownMember };

struct Datagram {
  MeshPath to;
  std::vector<std::uint8_t> bytes;
};

// One node of the mesh as a state machine: bytes and time in, bytes and events out. It reads no
// clock, opens no socket, draws no randomness of its own. One thread at a time.
class Endpoint {
 public:
  Endpoint(const EndpointConfig& config, std::shared_ptr<const KeySchedule> keys,
           MapSource& source);
  ~Endpoint();

  // The address is the sender's, whether it went to us or to the group.
  void on_datagram(MeshTime now, const MeshPath& from, std::span<const std::uint8_t> bytes);
  // The next datagram to send now; call until there is none.
  std::optional<Datagram> poll_transmit(MeshTime now);
  // When poll_transmit() may have something without anything else happening.
  MeshTime next_deadline() const;
  std::optional<MeshEvent> poll_event();

  // To one member, or to all that are up. At most UrgentFrame::kBytesMax.
  tl::expected<void, SendError> send_urgent(MeshTime now, std::optional<MemberId> to,
                                            std::span<const std::uint8_t> bytes);
  // To all: of each key the latest value only, as soon as it can go.
  tl::expected<void, SendError> set_telemetry(MeshTime now, std::uint16_t key,
                                              std::span<const std::uint8_t> bytes);
  // To a member, known or not: kept until it is handed over there.
  tl::expected<ParcelKey, SendError> send_parcel(MeshTime now, MemberId to, ParcelClass priority,
                                                 std::span<const std::uint8_t> bytes);
  // The layer above has stored what arrived.
  void finish_parcel(MeshTime now, MemberId from, ParcelKey key);
  // MapSource has something for this member again, or for the group of this interface.
  void wake(MeshTime now, MemberId member);
  void wake_group(InterfaceIndex interface);

  std::vector<Member> members() const;
  // Of this life, over all members.
  EndpointCounts counts() const;
  std::size_t memory_bytes() const;

  // What is unfinished, as bytes: parcels not handed over, streams, which were finished. Given to a
  // new Endpoint of the same member before anything else; false if the bytes are not sound.
  // Exactly once through crashes at any time, if the layer above (1) stores what save() gives right
  // after restore(), (2) stores what a parcel brought together with the save() after its
  // finish_parcel(), before the next poll_transmit(), (3) counts a parcel as accepted once the
  // save() after its send_parcel() is stored. Else at most a repetition, never a loss.
  std::vector<std::uint8_t> save() const;
  bool restore(std::span<const std::uint8_t> saved);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace warren::mesh
