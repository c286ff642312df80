// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "daemon/replication/command.hpp"
#include "daemon/replication/config.hpp"
#include "daemon/replication/log_book.hpp"
#include "daemon/replication/log_message.hpp"
#include "daemon/replication/provider_choice.hpp"
#include "daemon/replication/said.hpp"

namespace warren::replication {

// Keeps the logs of the fleet in step as layers are: announced, pulled from one neighbour each,
// which sends new items by itself; as parcels, a few at a time, commands and receipts first.
class LogExchange {
 public:
  static constexpr std::size_t kParcelsUnderWayMax = 8;  // to one member
  static constexpr std::size_t kBytesUnderWayMax = 64 * 1024;

  LogExchange(const ReplicationConfig& config, std::deque<Command>& commands)
      : config_(config), commands_(commands), book_(config.self, config.logs_max) {}

  LogBook& book() { return book_; }
  const LogBook& book() const { return book_; }

  void on_up(MemberId member, bool up);
  void on_restarted(MemberId member);
  // It must be down.
  void on_forgotten(MemberId member);
  void on_announcement(MemberId from, Slot slot, std::span<const std::uint8_t> bytes);
  // Whether the message was one of wishes.
  bool on_message(MemberId from, std::span<const std::uint8_t> bytes);
  // Whether the parcel was ours; it is finished when what it brought is stored.
  bool on_parcel(MeshTime now, const mesh::ParcelArrived& parcel);
  // What became of the SendParcel with this number: nothing if the endpoint refused it.
  void on_parcel_sent(std::uint64_t number, std::optional<mesh::ParcelKey> key);
  void on_parcel_delivered(const mesh::ParcelDelivered& delivered);
  void on_batch(std::uint64_t batch);
  void on_stored(MeshTime now, std::uint64_t batch);
  void on_refused(std::uint64_t batch) { book_.on_refused(batch); }

  void advance(MeshTime now);
  MeshTime next_deadline() const;

  // Wishes due to this member, as one map packet's bytes, and then what became of them.
  std::optional<std::vector<std::uint8_t>> next_wishes(MemberId to, std::size_t limit,
                                                       std::vector<Slot>& told);
  void on_wishes_lost(MemberId to, const std::vector<Slot>& told);

  const Way* way_of(Slot slot) const;
  std::uint64_t refused() const { return refused_; }
  std::size_t memory_bytes() const;

 private:
  struct Subscription {
    std::uint64_t number = 0;
    bool wanted = false;
    mesh::ByteRanges sent;  // it has these, or will
  };
  struct UnderWay {
    Slot slot = 0;
    mesh::ByteRanges numbers;
    std::size_t bytes = 0;
  };
  struct Peer {
    bool up = false;
    std::map<Slot, LogAnnouncement> announced;  // by its slot
    std::map<LogId, Slot> slots;
    std::map<Slot, Subscription> subscriptions;  // by ours
    std::set<Slot> wishes_due;
    std::map<std::uint64_t, UnderWay> handed_over;  // to the endpoint, by number
    std::map<mesh::ParcelKey, UnderWay> under_way;
    std::size_t under_way_bytes = 0;
    Slot last_served = 0;
  };
  struct Spoken {
    Said clock;
    std::optional<LogAnnouncement> last;
  };

  // Of parcels that brought nothing new no batch will tell.
  void finish_if_all_is_stored();
  void choose(const HeldLog& held);
  std::vector<Candidate> candidates(const HeldLog& held) const;
  void tell(MemberId member, Slot slot);
  void serve(MemberId id, Peer& peer);
  bool serve_one(MemberId id, Peer& peer, bool first_class);
  bool serve_log(MemberId id, Peer& peer, Slot slot, bool first_class);
  void send(MemberId id, Peer& peer, UnderWay what, mesh::ParcelClass priority,
            std::vector<std::uint8_t> bytes);
  void announce();
  void say(const HeldLog& held, Spoken& spoken);
  Said::Thing thing_of(const HeldLog& held) const;

  const ReplicationConfig& config_;
  std::deque<Command>& commands_;
  MeshTime now_{};
  LogBook book_;
  std::map<MemberId, Peer> peers_;
  std::map<Slot, Way> ways_;  // of the logs of others
  std::map<Slot, Spoken> spoken_;
  std::vector<std::pair<MemberId, mesh::ParcelKey>> to_finish_;
  std::deque<std::pair<std::uint64_t, FinishParcel>> finishing_;  // by batch
  bool choose_ = false;
  MeshTime next_said_ = kNever;
  std::uint64_t parcels_ = 0;
  std::uint64_t wishes_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace warren::replication
