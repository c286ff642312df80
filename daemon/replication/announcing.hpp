// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/digest_walk.hpp"
#include "daemon/replication/node_state.hpp"
#include "daemon/replication/pulling.hpp"
#include "daemon/replication/said.hpp"

namespace warren::replication {

// Says which layers are held, as seldom as will do: see Said. A layer that is new is told at once.
class Announcing {
 public:
  Announcing(NodeState& node, const Pulling& pulling, DigestWalk& walk)
      : node_(node), pulling_(pulling), walk_(walk) {}

  void advance();
  MeshTime next_deadline() const { return next_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t sent_bytes() const { return sent_bytes_; }

 private:
  struct Spoken {
    Said clock;
    std::optional<Announcement> last;
  };
  Said::Thing thing_of(const HeldLayer& layer) const;
  MeshTime due(const HeldLayer& layer, Spoken& spoken) const;
  void say(const HeldLayer& layer, Spoken& spoken);
  bool is_quiet(const HeldLayer& layer) const;

  NodeState& node_;
  const Pulling& pulling_;
  DigestWalk& walk_;
  std::map<Slot, Spoken> spoken_;
  MeshTime next_ = kNever;
  std::uint64_t sent_ = 0;
  std::uint64_t sent_bytes_ = 0;
};

}  // namespace warren::replication
