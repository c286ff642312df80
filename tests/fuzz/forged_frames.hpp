// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "tests/fuzz/fuzz_bytes.hpp"
#include "transport/wire/beacon.hpp"
#include "transport/wire/frames.hpp"

namespace warren::fuzz {

// What a member that lies may know.
struct Known {
  std::uint64_t newest = 0;                    // number of the packets that came from its victim
  std::span<const mesh::ParcelKey> parcels;    // that the victim sends or gets
  std::span<const std::uint32_t> boot_halves;  // lower halves of boots, to be named in beacons
};

// A frame that can be encoded, and says whatever the input wants.
mesh::Frame forged_frame(FuzzBytes& in, const Known& known);
mesh::Beacon forged_beacon(FuzzBytes& in, const Known& known);

}  // namespace warren::fuzz
