// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/flow/ticket.hpp"
#include "transport/wire/frames.hpp"

namespace warren::mesh {

// A frame for the next packet, and what to hand back when that packet is acknowledged or lost.
struct OutgoingFrame {
  Frame frame;
  Ticket ticket;
};

}  // namespace warren::mesh
