// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace warren::mesh {

// What was not sent or not handed on, and why. Of one peer, or summed over several.
struct OutboxCounts {
  std::uint64_t urgent_expired = 0;       // not acknowledged within the time limit
  std::uint64_t urgent_superseded = 0;    // dropped for newer ones: too many unacknowledged
  std::uint64_t urgent_copies = 0;        // sent beyond the first
  std::uint64_t telemetry_replaced = 0;   // values that a newer one replaced before they were sent
  std::uint64_t telemetry_oversized = 0;  // values that no packet to this peer can hold
  std::uint64_t telemetry_repeated = 0;   // values sent again, the earlier packet being lost
  std::uint64_t parcels_refused = 0;      // too large, or no room
  std::uint64_t parcels_delivered = 0;
  std::uint64_t parcel_bytes_sent = 0;
  std::uint64_t parcel_bytes_repeated = 0;  // to be sent again: lost, or dropped at the other side
  std::uint64_t parcel_questions = 0;
  std::uint64_t states_unknown = 0;  // of parcels that are not ours or not unfinished
  std::uint64_t states_malformed = 0;
};

struct InboxCounts {
  std::uint64_t urgent_delivered = 0;
  std::uint64_t urgent_duplicate = 0;  // or too old to tell
  std::uint64_t telemetry_delivered = 0;
  std::uint64_t telemetry_stale = 0;    // not newer than what was delivered
  std::uint64_t telemetry_refused = 0;  // too many keys
  std::uint64_t parcels_delivered = 0;
  std::uint64_t parcels_forgotten = 0;    // begun, then given up by their sender
  std::uint64_t parcels_evicted = 0;      // begun, dropped for an earlier one or for other peers
  std::uint64_t fragments_duplicate = 0;  // nothing new in them
  std::uint64_t fragments_finished = 0;   // of parcels finished already
  std::uint64_t fragments_malformed = 0;  // beyond the total, or against what was said before
  std::uint64_t fragments_refused = 0;    // no room; the sender will ask and send again
  std::uint64_t answers_dropped = 0;      // too many were due; the sender will ask again
  std::uint64_t old_stream = 0;           // of the stream before the present one
  std::uint64_t unexpected_frames = 0;    // of a kind that is not the inbox's
};

// A count and its name, as whoever prints them wants it.
template <typename Counts>
struct NamedCount {
  const char* name;
  std::uint64_t Counts::*count;
};

inline constexpr std::array kOutboxCounts{
    NamedCount<OutboxCounts>{"urgent_expired", &OutboxCounts::urgent_expired},
    NamedCount<OutboxCounts>{"urgent_superseded", &OutboxCounts::urgent_superseded},
    NamedCount<OutboxCounts>{"urgent_copies", &OutboxCounts::urgent_copies},
    NamedCount<OutboxCounts>{"telemetry_replaced", &OutboxCounts::telemetry_replaced},
    NamedCount<OutboxCounts>{"telemetry_oversized", &OutboxCounts::telemetry_oversized},
    NamedCount<OutboxCounts>{"telemetry_repeated", &OutboxCounts::telemetry_repeated},
    NamedCount<OutboxCounts>{"parcels_refused", &OutboxCounts::parcels_refused},
    NamedCount<OutboxCounts>{"parcels_delivered", &OutboxCounts::parcels_delivered},
    NamedCount<OutboxCounts>{"parcel_bytes_sent", &OutboxCounts::parcel_bytes_sent},
    NamedCount<OutboxCounts>{"parcel_bytes_repeated", &OutboxCounts::parcel_bytes_repeated},
    NamedCount<OutboxCounts>{"parcel_questions", &OutboxCounts::parcel_questions},
    NamedCount<OutboxCounts>{"states_unknown", &OutboxCounts::states_unknown},
    NamedCount<OutboxCounts>{"states_malformed", &OutboxCounts::states_malformed},
};
static_assert(sizeof(OutboxCounts) == kOutboxCounts.size() * sizeof(std::uint64_t));

inline constexpr std::array kInboxCounts{
    NamedCount<InboxCounts>{"urgent_delivered", &InboxCounts::urgent_delivered},
    NamedCount<InboxCounts>{"urgent_duplicate", &InboxCounts::urgent_duplicate},
    NamedCount<InboxCounts>{"telemetry_delivered", &InboxCounts::telemetry_delivered},
    NamedCount<InboxCounts>{"telemetry_stale", &InboxCounts::telemetry_stale},
    NamedCount<InboxCounts>{"telemetry_refused", &InboxCounts::telemetry_refused},
    NamedCount<InboxCounts>{"parcels_delivered", &InboxCounts::parcels_delivered},
    NamedCount<InboxCounts>{"parcels_forgotten", &InboxCounts::parcels_forgotten},
    NamedCount<InboxCounts>{"parcels_evicted", &InboxCounts::parcels_evicted},
    NamedCount<InboxCounts>{"fragments_duplicate", &InboxCounts::fragments_duplicate},
    NamedCount<InboxCounts>{"fragments_finished", &InboxCounts::fragments_finished},
    NamedCount<InboxCounts>{"fragments_malformed", &InboxCounts::fragments_malformed},
    NamedCount<InboxCounts>{"fragments_refused", &InboxCounts::fragments_refused},
    NamedCount<InboxCounts>{"answers_dropped", &InboxCounts::answers_dropped},
    NamedCount<InboxCounts>{"old_stream", &InboxCounts::old_stream},
    NamedCount<InboxCounts>{"unexpected_frames", &InboxCounts::unexpected_frames},
};
static_assert(sizeof(InboxCounts) == kInboxCounts.size() * sizeof(std::uint64_t));

inline OutboxCounts& operator+=(OutboxCounts& sum, const OutboxCounts& more) {
  for (const auto& [name, count] : kOutboxCounts) sum.*count += more.*count;
  return sum;
}

inline InboxCounts& operator+=(InboxCounts& sum, const InboxCounts& more) {
  for (const auto& [name, count] : kInboxCounts) sum.*count += more.*count;
  return sum;
}

}  // namespace warren::mesh
