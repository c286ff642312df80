// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "transport/endpoint/endpoint.hpp"

namespace warren::replication {

// What replication wants of the endpoint; each is one call of it.
struct SetTelemetry {
  std::uint16_t key = 0;
  std::vector<std::uint8_t> bytes;
};
struct Wake {
  MemberId member;
};
struct WakeGroup {
  InterfaceIndex interface = 0;
};
// Tell Replication::on_parcel_sent() what became of it.
struct SendParcel {
  MemberId to;
  mesh::ParcelClass priority = mesh::ParcelClass::kMessage;
  std::vector<std::uint8_t> bytes;
  std::uint64_t number = 0;
};
struct FinishParcel {
  MemberId from;
  mesh::ParcelKey key;
};
using Command = std::variant<SetTelemetry, Wake, WakeGroup, SendParcel, FinishParcel>;

}  // namespace warren::replication
