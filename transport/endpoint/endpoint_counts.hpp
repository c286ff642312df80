// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "transport/delivery/delivery_counts.hpp"

namespace warren::mesh {

// Why something that came in was not used.
enum class Unused : std::uint8_t {
  kNoPacketOfOurs,     // too short, another format version, an unknown type
  kOwnEcho,            // our own boot: a group's loop
  kOwnMember,          // our own member id from another boot: two nodes have one number
  kNotAuthentic,       // sealed with another key, for another life, or corrupted
  kMalformed,          // authentic and yet not readable
  kReplayed,           // its number has come already, or is too old
  kRetiredBoot,        // of a life that has ended
  kNotFresh,           // authentic, but perhaps recorded: what it says has to be proved
  kUnknownSender,      // authentic, but does not say who sends
  kMemberTableFull,    // a new member beyond members_max, and nobody to be forgotten
  kAnswerRateLimited,  // beacons of unconfirmed boots that got no answer
  kCount
};

inline constexpr std::array<const char*, static_cast<std::size_t>(Unused::kCount)> kUnusedNames{
    "no_packet_of_ours", "own_echo",          "own_member",         "not_authentic",
    "malformed",         "replayed",          "retired_boot",       "not_fresh",
    "unknown_sender",    "member_table_full", "answer_rate_limited"};

// First as SendClass, then what goes to all.
enum class SentClass : std::uint8_t {
  kUrgent,
  kControl,  // hello, ping, acknowledgements, states of parcels
  kTelemetry,
  kControlParcel,
  kMessageParcel,
  kFresh,
  kBacklog,
  kBeacon,
  kGroup,
  kCount
};

inline constexpr std::array<const char*, static_cast<std::size_t>(SentClass::kCount)>
    kSentClassNames{"urgent", "control", "telemetry", "control_parcel", "message_parcel",
                    "fresh",  "backlog", "beacon",    "group"};

struct ClassCounts {
  std::uint64_t packets = 0;  // with something of this class
  std::uint64_t bytes = 0;    // of its frames; envelope and IP header left out
};

struct EndpointCounts {
  std::array<std::uint64_t, static_cast<std::size_t>(Unused::kCount)> unused{};
  std::array<ClassCounts, static_cast<std::size_t>(SentClass::kCount)> sent{};
  std::uint64_t packets_in = 0;
  std::uint64_t ip_bytes_in = 0;
  std::uint64_t packets_out = 0;
  std::uint64_t ip_bytes_out = 0;
  std::uint64_t members_forgotten = 0;  // for new ones, the table being full
  // Over all members, those forgotten too.
  OutboxCounts outbox;
  InboxCounts inbox;

  std::uint64_t& operator[](Unused reason) { return unused[static_cast<std::size_t>(reason)]; }
  std::uint64_t operator[](Unused reason) const { return unused[static_cast<std::size_t>(reason)]; }
  ClassCounts& operator[](SentClass of) { return sent[static_cast<std::size_t>(of)]; }
  const ClassCounts& operator[](SentClass of) const { return sent[static_cast<std::size_t>(of)]; }
};

}  // namespace warren::mesh
