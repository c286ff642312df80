// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "transport/endpoint/endpoint.hpp"
#include "transport/wire/envelope.hpp"

namespace warren::fuzz {

// A layer above with so many map packets to send.
class MapSupply : public mesh::MapSource {
 public:
  std::array<std::size_t, 2> left{};  // by class
  std::size_t group_left = 0;
  std::size_t bytes = 1000;  // of each, if there is room for so many

  static constexpr std::size_t kBytesMin = 440;  // as diff packets need
  std::size_t bytes_min() const override { return kBytesMin; }
  std::optional<Packet> next_for(MemberId to, mesh::MapClass wanted, std::size_t limit) override;
  std::optional<Packet> next_for_group(InterfaceIndex interface, std::size_t limit) override;
  void on_acknowledged(MemberId to, std::uint64_t ticket) override;
  void on_lost(MemberId to, std::uint64_t ticket) override;

 private:
  std::uint64_t next_ticket_ = 0;
};

// One node with what its layer above has stored, and what it has seen in this life.
struct PairSide {
  MemberId id;
  BootId boot;
  MapSupply map;
  std::unique_ptr<mesh::Endpoint> endpoint;
  std::uint8_t address = 0;
  std::vector<std::uint8_t> store;
  std::deque<std::pair<std::uint64_t, mesh::ParcelKey>> waiting;  // arrived, not stored
  std::set<std::uint64_t> stored;                                 // numbers of payloads
  std::set<std::uint64_t> urgent;
  std::map<std::uint16_t, std::uint64_t> telemetry;  // the latest by key
};

// Two endpoints in virtual time that know each other, the air between them, and all keys. After
// each step: nothing is due in the past, memory is bounded, what is handed on was sent, and is
// handed on once, as long as nobody lied.
class MeshPair {
 public:
  static constexpr std::size_t kInterfaces = 2;
  static constexpr std::size_t kMembersMax = 6;

  struct Flight {
    std::size_t from = 0;
    MeshPath source;
    mesh::Datagram datagram;
    MeshTime arrives;
  };
  enum class Air : std::uint8_t { kCarries, kHolds, kLoses };

  MeshPair();  // until they know each other

  void pass(Duration time, Air air);
  // As when the machine slept.
  void jump(Duration time);
  void send_parcel(std::size_t from, MemberId to, mesh::ParcelClass priority, std::size_t bytes);
  void send_urgent(std::size_t from, bool to_all, std::size_t bytes);
  void set_telemetry(std::size_t from, std::uint16_t key, std::size_t bytes);
  void add_map(std::size_t from, std::size_t packets, std::size_t group, std::size_t bytes);
  // The layer above has stored the oldest parcel that waits.
  void store_parcel(std::size_t side);
  void restart(std::size_t side);
  void move(std::size_t side) { sides_[side].address += 2; }

  // What is on its way; at most kFlightsMax, the oldest gives way.
  std::deque<Flight>& air() { return air_; }
  void deliver(const Flight& flight);
  // Whoever calls this lies: from then on only safety is asked for.
  void inject(std::size_t to, const MeshPath& from, std::span<const std::uint8_t> bytes);

  PairSide& side(std::size_t index) { return sides_[index]; }
  const mesh::KeySchedule& keys() const { return *keys_; }
  std::span<const mesh::ParcelKey> parcels() const { return parcels_; }
  // The highest number used so far by this boot in packets of this type.
  std::uint64_t& newest(BootId boot, mesh::PacketType type) { return newest_[{boot, type}]; }
  BootId fresh_boot() { return BootId{0x1000'0000'0000'0000U + ++boots_}; }
  MeshPath path_of(std::size_t side, std::size_t interface) const;

  // What was caused just now.
  void settle();
  void check_memory() const;
  // Nobody lied: with a good link everything promised is kept.
  void heal();

 private:
  static constexpr std::size_t kFlightsMax = 128;

  void start(std::size_t side);
  void pump(std::size_t side);
  bool quiet() const;
  void on_event(PairSide& side, mesh::MeshEvent&& event);
  std::vector<std::uint8_t> payload(std::size_t bytes);
  std::optional<std::uint64_t> number_of(std::span<const std::uint8_t> payload) const;

  MeshTime now_{std::chrono::seconds(1000)};
  std::shared_ptr<const mesh::KeySchedule> keys_;
  std::array<PairSide, 2> sides_;
  std::deque<Flight> air_;
  std::map<std::pair<BootId, mesh::PacketType>, std::uint64_t> newest_;
  std::vector<mesh::ParcelKey> parcels_;
  std::set<std::pair<std::size_t, std::uint64_t>> promised_;  // to which side, number
  std::uint64_t payloads_ = 0;
  std::uint64_t boots_ = 0;
  std::uint64_t sent_ = 0;  // packets
  Duration passed_{};
  std::size_t heap_before_ = 0;
  bool honest_ = true;
};

}  // namespace warren::fuzz
