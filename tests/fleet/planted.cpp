// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/planted.hpp"

#include "core/layer/packet_header.hpp"

namespace warren::fleet_sim {
namespace {

// The same blocks, said to be all that changed in every key.
void widen_claim(std::vector<std::uint8_t>& bytes) {
  const auto message = replication::read_map_message(bytes);
  const auto* const diff = message ? std::get_if<replication::DiffMessage>(&*message) : nullptr;
  if (diff == nullptr) return;
  const auto header = read_header(diff->packet);
  if (!header || header->claim.keys.end == kOrdinalEnd) return;
  auto wide =
      write_header({{header->claim.keys.first, kOrdinalEnd}, header->claim.from, header->claim.to});
  const auto body = diff->packet.subspan(header->bytes);
  wide.insert(wide.end(), body.begin(), body.end());
  bytes = replication::encode(replication::DiffMessage{diff->slot, wide});
}

}  // namespace

std::optional<mesh::MapSource::Packet> PlantedSource::next_for(MemberId to, mesh::MapClass wanted,
                                                               std::size_t limit) {
  auto packet = inner_.next_for(to, wanted, limit);
  if (packet && planted_ == Planted::kClaimWidened) widen_claim(packet->bytes);
  return packet;
}

}  // namespace warren::fleet_sim
