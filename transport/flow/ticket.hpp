// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>

#include "transport/wire/frames.hpp"

namespace warren::mesh {

// What a packet carried, as the one who filled it wants to hear of it when the packet is
// acknowledged or lost. Flow only keeps tickets.
struct UrgentTicket {
  std::uint32_t number = 0;
  friend bool operator==(const UrgentTicket&, const UrgentTicket&) = default;
};
struct TelemetryTicket {
  std::uint16_t key = 0;
  std::uint32_t version = 0;
  friend bool operator==(const TelemetryTicket&, const TelemetryTicket&) = default;
};
struct FragmentTicket {
  ParcelKey parcel;
  NumberRange bytes;
  friend bool operator==(const FragmentTicket&, const FragmentTicket&) = default;
};
struct ParcelStateTicket {
  ParcelKey parcel;
  friend bool operator==(const ParcelStateTicket&, const ParcelStateTicket&) = default;
};
struct MapTicket {
  std::uint64_t number = 0;
  MapClass priority = MapClass::kBacklog;
  friend bool operator==(const MapTicket&, const MapTicket&) = default;
};

using Ticket =
    std::variant<UrgentTicket, TelemetryTicket, FragmentTicket, ParcelStateTicket, MapTicket>;

}  // namespace warren::mesh
