// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/packet_size.hpp"

#include <algorithm>

namespace warren::mesh {

void PacketSize::on_passed(std::size_t ip_bytes) {
  if (ip_bytes <= kSmallBytes) {
    if (large_lost_ > 0) ++small_passed_;
    return;
  }
  large_pass_ = true;
  large_lost_ = small_passed_ = small_probes_ = 0;
}

void PacketSize::on_lost(MeshTime now, std::size_t ip_bytes) {
  if (ip_bytes <= kSmallBytes || !large_pass_) return;
  ++large_lost_;
  if (large_lost_ < kLargeLostInRow || small_passed_ < kSmallPassed) return;
  large_pass_ = false;
  probe_at_ = now + kProbeAgain;
}

std::size_t PacketSize::limit(std::size_t mtu_bytes) const {
  return large_pass_ ? mtu_bytes : std::min(mtu_bytes, kSmallBytes);
}

bool PacketSize::wants_small_probe() const {
  return large_pass_ && large_lost_ >= kSuspicious && small_probes_ < large_lost_;
}

}  // namespace warren::mesh
