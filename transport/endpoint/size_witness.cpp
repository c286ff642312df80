// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/size_witness.hpp"

#include <algorithm>

namespace warren::mesh {

void SizeWitness::on_sent(MeshTime now, std::uint64_t number, std::size_t ip_bytes) {
  if (packets_.size() == kPacketsMax) packets_.pop_front();
  packets_.push_back({number, ip_bytes, now});
}

void SizeWitness::on_ack(MeshTime now, const AckFrame& ack, PacketSize& size) {
  if (ack.ranges.empty() || packets_.empty()) return;
  const std::uint64_t end = ack.ranges.front().end;
  const auto settled = [&](const Packet& packet) {
    for (const NumberRange& range : ack.ranges) {
      if (packet.number >= range.end) break;  // the lower ones are lower still
      if (packet.number < range.first) continue;
      size.on_passed(packet.ip_bytes);
      return true;
    }
    if (packet.number + kOvertakenBy >= end) return false;
    size.on_lost(now, packet.ip_bytes);
    return true;
  };
  packets_.erase(std::remove_if(packets_.begin(), packets_.end(), settled), packets_.end());
}

void SizeWitness::on_time(MeshTime now, Duration rtt, PacketSize& size) {
  const Duration wait = std::max(kWaitLeast, 3 * rtt);
  while (!packets_.empty() && packets_.front().sent + wait < now) {
    size.on_lost(now, packets_.front().ip_bytes);
    packets_.pop_front();
  }
}

}  // namespace warren::mesh
