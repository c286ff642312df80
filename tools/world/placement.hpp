// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "tools/world/caster.hpp"
#include "tools/world/vehicle.hpp"
#include "tools/world/wheel_contact.hpp"

namespace warren::world {

enum class Verdict : std::uint8_t {
  kOk,
  kNoGround,     // a wheel hangs over nothing
  kTooSteep,     // pitch or roll beyond the vehicle's limit
  kRocking,      // the contacts are too far from one plane
  kHighCentred,  // the ground reaches the belly between the axles
  kBlocked,      // something is where the body or a wheel should be
};
const char* name_of(Verdict verdict);  // snake_case

struct Placement {
  Verdict verdict = Verdict::kNoGround;
  // Where the vehicle comes to rest, whatever the verdict; none if a wheel finds no place.
  std::optional<Eigen::Isometry3d> T_world_base{};
  double roll_rad = 0.0;   // left side up
  double pitch_rad = 0.0;  // nose down

  bool is_ok() const { return verdict == Verdict::kOk; }
};

// Lowers a vehicle onto the mesh by rays alone and says whether it can stand there. The plane
// nearest to the four contacts is where it rests; springs or knees take up the rest, up to
// max_warp_m.
Placement place(const Caster& caster, const Vehicle& vehicle, const Stand& stand);

}  // namespace warren::world
