// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "transport/endpoint/endpoint.hpp"

namespace warren::mesh::sim {

// What every payload of the simulation begins with, so that whoever gets it knows what it must be.
struct Stamp {
  std::uint32_t from = 0;
  std::uint32_t life = 0;  // of the sender, counted from 0
  std::uint32_t kind = 0;  // telemetry key, map class
  std::uint64_t number = 0;
};
inline constexpr std::size_t kStampBytes = 20;
// Stamp, then bytes that follow from it. Precondition: at least kStampBytes.
std::vector<std::uint8_t> stamped(const Stamp& stamp, std::size_t bytes);
// Nothing unless each byte is as stamped() made it.
std::optional<Stamp> read_stamped(std::span<const std::uint8_t> bytes);

// Everything promised, held against everything that happened. Only the simulation knows both ends.
class Ledger {
 public:
  struct Parcel {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint64_t number = 0;
    std::size_t bytes = 0;
    MeshTime sent;
    std::optional<MeshTime> arrived;
    bool reported = false;  // ParcelDelivered
    bool excused = false;   // a store was lost: may arrive again, or never
  };

  void on_parcel_sent(MeshTime now, const Parcel& parcel, ParcelKey key);
  void on_parcel_arrived(MeshTime now, std::uint32_t at, std::span<const std::uint8_t> bytes);
  void on_parcel_delivered(MeshTime now, std::uint32_t from, std::uint32_t to, ParcelKey key);
  void on_telemetry(MeshTime now, std::uint32_t at, std::uint32_t at_life,
                    std::span<const std::uint8_t> bytes);
  void on_urgent(MeshTime now, std::uint32_t at, std::uint32_t at_life,
                 std::span<const std::uint8_t> bytes);
  void on_map(MeshTime now, std::uint32_t at, std::span<const std::uint8_t> bytes);
  void on_map_acknowledged(MeshTime now, std::uint32_t from, std::uint64_t ticket);
  // A datagram that is sent, and, for one sealed for a pair, the boot that it is sealed for.
  void on_datagram(MeshTime now, std::optional<BootId> receiver,
                   std::span<const std::uint8_t> bytes);
  // The node lost its store: what it had sent or received may be lost or come again.
  void on_store_lost(std::uint32_t node);
  void on_memory(MeshTime now, std::uint32_t node, std::size_t bytes, std::size_t bound);
  void fail(MeshTime now, const std::string& what);

  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<Parcel>& parcels() const { return parcels_; }
  // Parcels that have to arrive still.
  std::size_t outstanding() const;
  std::size_t outstanding_bytes() const;
  std::size_t map_packets_arrived(std::uint32_t at, MapClass priority) const;

 private:
  static constexpr std::size_t kFailuresMax = 20;

  std::vector<std::string> failures_;
  std::vector<Parcel> parcels_;
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::size_t> by_number_;  // from, number
  std::map<std::tuple<std::uint32_t, std::uint32_t, ParcelKey>, std::size_t> by_key_;
  // at, its life, from, key: life and number
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>,
           std::pair<std::uint32_t, std::uint64_t>>
      telemetry_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint64_t>, int> urgent_;
  std::map<std::pair<std::uint32_t, std::uint64_t>, int> map_arrived_;  // from, ticket
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint64_t>, int> map_arrived_at_;
  std::map<std::pair<std::uint32_t, MapClass>, std::size_t> map_counts_;
  std::unordered_map<std::uint64_t, std::uint64_t> datagrams_;  // digests: of name, of bytes
  std::size_t outstanding_ = 0;
  std::size_t outstanding_bytes_ = 0;
};

}  // namespace warren::mesh::sim
