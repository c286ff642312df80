// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Whether a member is up: heard lately, and hears us. It goes down only after several beacons in a
// row are missing, and then needs new evidence of both to come up.
class Liveness {
 public:
  static constexpr int kBeaconsMissed = 6;
  static constexpr Duration kHeardLeast = std::chrono::seconds(4);
  // The lists of whom a beacon's sender hears take several beacons in a crowd.
  static constexpr int kHearsUsFactor = 3;

  // crowd: of how many members its sender may hear.
  void on_beacon(MeshTime now, Duration period, std::size_t crowd = 0);
  void on_pair_packet(MeshTime now);  // whoever seals for us has heard us
  void on_hears_us(MeshTime now) { hears_us_ = now; }

  // Ups and downs since the last call: true for up.
  std::optional<bool> update(MeshTime now);
  bool up() const { return up_; }
  // A beacon or two are missing.
  bool overdue(MeshTime now) const;
  MeshTime heard() const { return heard_; }
  Duration period() const { return period_; }
  MeshTime next() const;

 private:
  Duration heard_limit() const;
  Duration hears_us_limit() const;

  MeshTime heard_ = MeshTime::min();
  MeshTime hears_us_ = MeshTime::min();
  Duration period_ = std::chrono::seconds(1);
  std::size_t crowd_ = 0;
  bool up_ = false;
};

}  // namespace warren::mesh
