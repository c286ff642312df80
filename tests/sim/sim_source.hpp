// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "tests/sim/ledger.hpp"
#include "transport/endpoint/endpoint.hpp"

namespace warren::mesh::sim {

// A layer above with so many bytes of map for each member, or without end. What was lost goes
// again. It outlives its node's restarts.
class SimSource : public MapSource {
 public:
  SimSource(std::uint32_t self, Ledger& ledger) : self_(self), ledger_(ledger) {}

  // The caller wakes the endpoint.
  void add(MemberId to, MapClass priority, std::uint64_t bytes) {
    wanted_[to][static_cast<std::size_t>(priority)] += bytes;
  }
  void add_group(std::uint64_t bytes) { group_bytes_ += bytes; }
  void set_now(MeshTime now) { now_ = now; }
  std::size_t bytes_min() const override { return packet_bytes_min; }
  // The endpoint is gone: what it had is lost.
  void on_restart();

  std::optional<Packet> next_for(MemberId to, MapClass wanted, std::size_t limit) override;
  std::optional<Packet> next_for_group(InterfaceIndex interface, std::size_t limit) override;
  void on_acknowledged(MemberId to, std::uint64_t ticket) override;
  void on_lost(MemberId to, std::uint64_t ticket) override;

  // Acknowledged, of both classes.
  std::uint64_t delivered_bytes(MapClass priority) const {
    return delivered_[static_cast<std::size_t>(priority)];
  }
  // Still to be sent or acknowledged.
  std::uint64_t open_bytes() const;
  // A planted fault: never says that it has something of this class.
  std::optional<MapClass> starved;
  std::size_t packet_bytes_min = kStampBytes;  // set before the node starts

 private:
  struct UnderWay {
    MemberId to;
    MapClass priority = MapClass::kBacklog;
    std::size_t bytes = 0;
    bool lost = false;
  };
  std::uint32_t self_;
  Ledger& ledger_;
  MeshTime now_;
  std::uint64_t next_ticket_ = 1;
  std::map<MemberId, std::array<std::uint64_t, 2>> wanted_;
  std::map<std::uint64_t, UnderWay> under_way_;
  std::array<std::uint64_t, 2> delivered_{};
  std::uint64_t group_bytes_ = 0;
};

}  // namespace warren::mesh::sim
