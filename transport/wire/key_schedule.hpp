// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "transport/mesh_id.hpp"

namespace warren::mesh {

using Key = std::array<std::uint8_t, 32>;

// Where keys come from. Per-robot identities will come behind this interface.
class KeySchedule {
 public:
  virtual ~KeySchedule() = default;
  // What `sender` seals for everyone: beacons and group packets.
  virtual Key group_key(BootId sender) const = 0;
  // What `sender` seals for `receiver` alone. It depends on both lives: a packet recorded in an
  // earlier life of either opens nothing.
  virtual Key pair_key(BootId sender, BootId receiver) const = 0;
};

// All keys from one secret that every member of the fleet has.
class PresharedKeys : public KeySchedule {
 public:
  explicit PresharedKeys(const Key& fleet_key);
  Key group_key(BootId sender) const override;
  Key pair_key(BootId sender, BootId receiver) const override;

 private:
  Key fleet_key_;
};

}  // namespace warren::mesh
