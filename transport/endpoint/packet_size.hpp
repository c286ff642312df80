// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// Whether large packets pass on a path. Some radios silently pass only small ones: many large ones
// lost in a row while small ones pass mean that. A large probe is tried now and then.
class PacketSize {
 public:
  static constexpr std::size_t kSmallBytes = 576;  // of an IP packet
  static constexpr int kLargeLostInRow = 12;
  static constexpr int kSmallPassed = 4;
  // So many lost large ones make small probes worth while, to know whether those pass.
  static constexpr int kSuspicious = 4;
  static constexpr Duration kProbeAgain = std::chrono::seconds(10);

  void on_passed(std::size_t ip_bytes);
  void on_lost(MeshTime now, std::size_t ip_bytes);

  std::size_t limit(std::size_t mtu_bytes) const;
  // A packet of the full size is to be tried now, one that may be lost.
  bool wants_large_probe(MeshTime now) const { return !large_pass_ && now >= probe_at_; }
  void on_large_probe(MeshTime now) { probe_at_ = now + kProbeAgain; }
  // A small packet that asks for an acknowledgement is to be sent along with the large ones.
  bool wants_small_probe() const;
  void on_small_probe() { ++small_probes_; }

 private:
  bool large_pass_ = true;
  int large_lost_ = 0;
  int small_passed_ = 0;
  int small_probes_ = 0;
  MeshTime probe_at_{};
};

}  // namespace warren::mesh
