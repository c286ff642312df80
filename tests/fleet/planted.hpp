// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/replication/replication.hpp"
#include "tests/fleet/fleet.hpp"

namespace warren::fleet_sim {

// Stands between an endpoint and replication, and may spoil what passes.
class PlantedSource final : public mesh::MapSource {
 public:
  PlantedSource(replication::Replication& inner, Planted planted)
      : inner_(inner), planted_(planted) {}

  std::optional<Packet> next_for(MemberId to, mesh::MapClass wanted, std::size_t limit) override;
  std::optional<Packet> next_for_group(InterfaceIndex interface, std::size_t limit) override {
    return inner_.next_for_group(interface, limit);
  }
  void on_acknowledged(MemberId from, std::uint64_t ticket) override {
    inner_.on_acknowledged(from, ticket);
  }
  void on_lost(MemberId from, std::uint64_t ticket) override {
    if (planted_ == Planted::kLostIsBelieved) return inner_.on_acknowledged(from, ticket);
    inner_.on_lost(from, ticket);
  }

 private:
  replication::Replication& inner_;
  Planted planted_;
};

}  // namespace warren::fleet_sim
