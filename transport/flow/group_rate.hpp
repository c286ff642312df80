// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/mesh_time.hpp"

namespace warren::mesh {

// How fast to send what goes to all who hear an interface. Nobody acknowledges it; but what goes to
// single members waits in the same queues, and its acknowledgements tell how long. While these find
// none, the rate is raised as long as there is more to send than it lets out; a queue lowers it, to
// the pace of the slowest member at least. That pace alone would not do: to a member to whom hardly
// anything is sent it stays what it was when it was measured, however low.
class GroupRate {
 public:
  // An acknowledgement came of what was sent to a single member there. wanted: packets for all wait
  // for their turn; standing: Flow's queue to the member; slowest, fastest: paces of the members in
  // reach there, IP bytes/s.
  void on_acknowledged(MeshTime now, bool wanted, Duration standing, double slowest,
                       double fastest);

  // IP bytes/s.
  double pace(double slowest) const;

 private:
  double rate_ = 0.0;
  MeshTime changed_{};
};

}  // namespace warren::mesh
