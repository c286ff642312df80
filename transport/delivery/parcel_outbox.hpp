// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "transport/delivery/byte_ranges.hpp"
#include "transport/delivery/delivery_config.hpp"
#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/outgoing_frame.hpp"
#include "transport/delivery/parcel_budget.hpp"
#include "transport/delivery/saved_parcels.hpp"
#include "transport/mesh_time.hpp"

namespace warren::mesh {

enum class ParcelRefusal : std::uint8_t { kTooLarge, kFull };

// Parcels on their way to one peer, in one stream. A parcel is finished when its receiver says that
// it was handed over; until then it is kept. A restored stream goes on with a gap in its
// numbers: none is used twice by a life that crashed with up to kNumbersPerSave parcels unsaved, if
// each life saves once after it has restored and before it sends.
class ParcelOutbox {
 public:
  static constexpr std::uint32_t kNumbersPerSave = 4096;

  // `fresh_stream`: 64 random bits, used if nothing is restored.
  ParcelOutbox(const ParcelConfig& config, std::uint64_t fresh_stream, ParcelBudget& budget,
               OutboxCounts& counts);
  ~ParcelOutbox();
  ParcelOutbox(const ParcelOutbox&) = delete;
  ParcelOutbox& operator=(const ParcelOutbox&) = delete;

  tl::expected<ParcelKey, ParcelRefusal> send(ParcelClass priority,
                                              std::span<const std::uint8_t> bytes);
  // A fragment; every other one is of the parcel that has least left to send, so that a short one
  // is not held up by a long one, and the rest of the oldest.
  std::optional<OutgoingFrame> next(std::size_t room, ParcelClass priority);
  std::optional<OutgoingFrame> again(const FragmentTicket& ticket) const;
  // What we believe arrived, but no receipt came: a fragment without bytes asks.
  std::optional<OutgoingFrame> next_question(MeshTime now, std::size_t room);
  // When next_question() has something.
  MeshTime question_due() const;
  bool has_fragment(ParcelClass priority) const { return choose(priority).has_value(); }

  void on_acked(MeshTime now, const FragmentTicket& ticket);
  void on_lost(MeshTime now, const FragmentTicket& ticket);
  // The finished parcel, once, if that is what the peer says.
  std::optional<ParcelKey> on_state(MeshTime now, const ParcelStateFrame& state);
  // The peer has dropped what it had of unfinished parcels.
  void on_peer_restarted();

  std::size_t unfinished() const { return parcels_.size(); }
  std::size_t unfinished_bytes() const { return bytes_; }
  SavedOutgoing save() const;
  // Precondition: nothing was sent yet.
  void restore(SavedOutgoing saved);

 private:
  // The peer has dropped all it had of a parcel, perhaps for want of room: one fragment goes, and
  // the rest when the peer says that it keeps it.
  enum class Probe : std::uint8_t { kNone, kReady, kSent };
  struct Parcel {
    ParcelClass priority = ParcelClass::kMessage;
    std::vector<std::uint8_t> bytes;
    ByteRanges acked;    // the peer has it, as far as we know
    ByteRanges to_send;  // neither acked nor on its way
    bool begun = false;  // some of it was sent
    bool asked = false;  // a question is out, and nothing was sent since
    Probe probe = Probe::kNone;
    MeshTime ask_at = kNever;
  };
  // Numbers of the parcels that have a fragment to send.
  struct Sendable {
    std::set<std::uint32_t> begun;
    std::set<std::uint32_t> untouched;
  };
  using Parcels = std::map<std::uint32_t, Parcel>;
  void add(std::uint32_t number, ParcelClass priority, std::vector<std::uint8_t> bytes);
  Parcels::iterator find(const ParcelKey& key);
  std::optional<std::uint32_t> choose(ParcelClass priority) const;
  bool may_begin(const Parcel& parcel) const;
  OutgoingFrame fragment(Parcels::const_iterator parcel, NumberRange bytes) const;
  void begin(Parcel& parcel);
  void ask_at(Parcels::iterator parcel, MeshTime when);
  void ask_if_complete(Parcels::iterator parcel, MeshTime when);
  void note_sendable(Parcels::const_iterator parcel);
  void drop_from_acked(Parcel& parcel, const ParcelStateFrame& state);
  void finish(Parcels::iterator parcel);

  ParcelConfig config_;
  ParcelBudget& budget_;
  OutboxCounts& counts_;
  std::uint64_t fresh_stream_;
  std::uint64_t stream_;
  std::uint32_t next_number_ = 0;
  Parcels parcels_;                                         // unfinished, by number
  std::size_t bytes_ = 0;                                   // charged to the budget
  std::size_t begun_bytes_ = 0;                             // of those of which something was sent
  std::array<Sendable, 2> sendable_;                        // by class
  std::set<std::pair<MeshTime, std::uint32_t>> questions_;  // when to ask, about which number
  bool oldest_next_ = true;
};

}  // namespace warren::mesh
