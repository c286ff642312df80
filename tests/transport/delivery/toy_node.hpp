// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "transport/delivery/inbox.hpp"
#include "transport/delivery/outbox.hpp"
#include "transport/delivery/saved_parcels.hpp"
#include "transport/delivery/scheduler.hpp"

namespace warren::mesh::test {

using Random = std::mt19937_64;

inline std::uint64_t below(Random& random, std::uint64_t end) { return random() % end; }
inline bool chance(Random& random, double share) {
  return static_cast<double>(random() >> 11) < share * 9007199254740992.0;
}

// The bytes of the parcel with this id: none are like another's.
std::vector<std::uint8_t> parcel_bytes(std::uint64_t id, std::size_t size);
std::uint64_t parcel_id(const std::vector<std::uint8_t>& bytes);

// One side of a pair, with the layer above: its store takes what arrives after a while and survives
// every restart together with what was saved at the same moment.
class ToyNode {
 public:
  ToyNode(const DeliveryConfig& config, std::uint64_t seed);

  // Ids of parcels by what became of them here.
  std::map<std::uint64_t, std::size_t> stored;  // how often each came into the store
  std::set<std::uint64_t> promised;             // sent, and saved since
  std::set<std::uint64_t> sent;
  std::vector<std::uint64_t> delivered;  // known here to be stored at the other side
  std::vector<std::uint32_t> urgent;     // in order of arrival
  std::map<std::uint16_t, std::vector<std::uint32_t>> telemetry;  // values by key

  std::optional<ParcelKey> send_parcel(std::uint64_t id, std::size_t size, ParcelClass priority);
  void set_telemetry(std::uint16_t key, std::uint32_t value);
  void send_urgent(MeshTime now, std::uint32_t number);
  FilledPacket fill(MeshTime now, std::size_t room);
  void on_frames(MeshTime now, std::vector<Frame> frames);
  // The store takes some of what arrived, and the state is saved with it.
  void store_some(double share);
  void save();
  // A new life from what was saved last.
  void restart();
  void on_peer_restarted();

  const DeliveryConfig& config() const { return config_; }
  Outbox& outbox() { return *outbox_; }
  Inbox& inbox() { return *inbox_; }
  const ParcelBudget& received_budget() const { return *received_; }
  std::uint64_t life() const { return life_; }
  bool idle() const { return outbox_->unfinished_bytes() == 0 && arrived_.empty(); }

 private:
  void begin_life();

  DeliveryConfig config_;
  Random random_;
  std::uint64_t life_ = 0;
  std::vector<std::uint8_t> saved_;
  std::set<std::uint64_t> unsaved_;
  std::deque<ParcelInbox::Arrived> arrived_;  // in the memory of the layer above
  std::map<ParcelKey, std::uint64_t> ids_;    // of what was sent
  std::unique_ptr<TelemetryBoard> board_;
  std::unique_ptr<ParcelBudget> sent_;
  std::unique_ptr<ParcelBudget> received_;
  std::unique_ptr<Outbox> outbox_;
  std::unique_ptr<Inbox> inbox_;
  std::unique_ptr<Scheduler> scheduler_;
};

}  // namespace warren::mesh::test
