// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "transport/delivery/byte_ranges.hpp"
#include "transport/delivery/delivery_config.hpp"
#include "transport/delivery/delivery_counts.hpp"
#include "transport/delivery/outgoing_frame.hpp"
#include "transport/delivery/parcel_budget.hpp"
#include "transport/delivery/saved_parcels.hpp"

namespace warren::mesh {

// Parcels that come from one peer. Each is handed on once per life of ours, and after finish()
// never again, as long as what save() gave is restored. All memory is charged until finish(): who
// does not finish gets no more. A parcel is charged as its sender counts it; when it comes in many
// pieces, their ranges come on top.
class ParcelInbox {
 public:
  static constexpr std::size_t kRangesPerParcelMax = 1024;
  static constexpr std::size_t kRangeBytesMax =
      256'000;  // of all parcels, beyond their flat charge

  struct Arrived {
    ParcelKey key;
    ParcelClass priority = ParcelClass::kMessage;
    std::vector<std::uint8_t> bytes;
  };

  ParcelInbox(const ParcelConfig& config, ParcelBudget& budget, InboxCounts& counts)
      : config_(config), budget_(budget), counts_(counts) {}
  ~ParcelInbox();
  ParcelInbox(const ParcelInbox&) = delete;
  ParcelInbox& operator=(const ParcelInbox&) = delete;

  // The whole parcel, if this fragment was its last missing one.
  std::optional<Arrived> on_fragment(const ParcelFrame& fragment);
  // It is safe with the layer above. May be told of parcels that were handed on in an earlier life,
  // too: then they are not handed on again. Keys of other streams are ignored.
  void finish(const ParcelKey& key);

  std::optional<OutgoingFrame> next_answer(std::size_t room);
  bool answers_due() const { return !answers_.empty(); }
  void on_lost(const ParcelStateTicket& ticket);
  // The sender may not know any more what it has sent: tell it.
  void on_peer_restarted();
  // Gives back what unfinished parcels hold that were not handed on; their sender sends them again.
  void drop_partial();

  // Charged to the budget.
  std::size_t unfinished_bytes() const { return bytes_ + range_bytes_; }
  // Parcels handed on and not finished.
  std::size_t handed_on() const;
  SavedIncoming save() const;
  // Precondition: nothing has come yet.
  void restore(const SavedIncoming& saved);

 private:
  struct Parcel {
    ParcelClass priority = ParcelClass::kMessage;
    std::uint32_t total = 0;
    bool handed_on = false;  // then without bytes
    ByteRanges have;
    std::vector<std::uint8_t> bytes;  // total of them
  };
  bool is_finished(std::uint32_t number) const;
  void enter_stream(std::uint64_t stream);
  void forget_before(std::uint32_t number);
  bool contradicts(const ParcelFrame& fragment) const;
  Parcel* admit(const ParcelFrame& fragment);
  bool take_room(std::size_t charge, ParcelClass priority);
  bool evict_after(std::uint32_t number);
  bool charge_ranges(const ByteRanges& before, const ByteRanges& after);
  std::optional<Arrived> store(const ParcelFrame& fragment, Parcel& parcel);
  void release(std::map<std::uint32_t, Parcel>::iterator parcel);
  void answer(std::uint32_t number);

  ParcelConfig config_;
  ParcelBudget& budget_;
  InboxCounts& counts_;
  std::optional<std::uint64_t> stream_;
  std::optional<std::uint64_t> previous_stream_;
  std::uint32_t finished_before_ = 0;
  ByteRanges finished_;                      // numbers, from finished_before_ on
  std::map<std::uint32_t, Parcel> parcels_;  // begun, or handed on and not finished
  std::size_t bytes_ = 0;                    // charged to the budget, flat
  std::size_t range_bytes_ = 0;              // and on top
  std::set<std::uint32_t> answers_;          // numbers of which a state is due
};

}  // namespace warren::mesh
