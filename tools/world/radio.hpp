// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "tools/world/random.hpp"

namespace warren::world {

// The radio of the DARPA SubT simulator (osrf/subt, its parameters for the competition), as
// equations: received power falls with the distance to the power of n, n grows with what stands
// between (RadioLink::cost), power fades at random, and packets are lost by bit errors.
struct RadioModel {
  double tx_power_dbm = 20.0;
  double noise_floor_dbm = -90.0;
  double rate_bit_s = 1e6;
  double max_range_m = 500.0;
  double loss_at_1_m_db = 40.0;
  double exponent = 1.5;
  double exponent_per_cost = 0.2;
  double max_cost = 10.0;             // no link beyond
  double fading_variance_db2 = 10.0;  // called sigma there, but used as a variance
  double distance_scale = 0.55;
  double distance_per_hop_m = 2.0;
};

struct RadioLink {
  double distance_m = 0.0;
  double cost = 0.0;  // of the way through the tiles between
  unsigned hops = 0;  // relays on the way
};

// None where there is no link at all: too far, or too much rock.
std::optional<double> path_loss_db(const RadioModel& model, const RadioLink& link);

// Chance that a bit, in truth a byte, arrives wrong (QPSK).
double bit_error_rate(const RadioModel& model, double received_dbm);

// Chance that a packet is lost. By the byte, not by the bit, as the simulator computes it.
double packet_loss(const RadioModel& model, double received_dbm, std::size_t bytes);

// Of one packet, or of all packets during a time for which the fading stands still.
struct RadioState {
  double loss = 1.0;
  double rate_bit_s = 0.0;
};
RadioState radio_state(const RadioModel& model, const RadioLink& link, std::size_t bytes,
                       Random& fading);

}  // namespace warren::world
