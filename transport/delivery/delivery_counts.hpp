// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace warren::mesh {

// What was not sent or not handed on, and why. Sums over all peers if so used.
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

}  // namespace warren::mesh
