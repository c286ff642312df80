// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/replication/node_state.hpp"

namespace warren::replication {

// Fresh packets for all who hear one interface. What two or more members there lack goes to the
// group, once, and is taken for delivered: nobody acknowledges it, who missed it says so. What only
// one lacks goes to that one.
class GroupServing {
 public:
  // Members further apart than so many revisions are not told the same.
  static constexpr std::uint32_t kTogetherWithin = 8;

  explicit GroupServing(NodeState& node) : node_(node) {}

  bool enabled(InterfaceIndex interface) const {
    const auto& groups = node_.config.group_broadcast;
    return interface < groups.size() && groups[interface];
  }
  // Whether the member gets its next fresh packet of this layer with others.
  bool serves(const Peer& member, Slot slot) const;
  std::optional<mesh::MapSource::Packet> next_for(InterfaceIndex interface, std::size_t limit);
  void wake(InterfaceIndex interface) const;
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Group {
    KeyInterval keys;
    Revision from;
    std::vector<MemberId> members;
  };
  std::optional<Group> group_of(InterfaceIndex interface, const HeldLayer& layer) const;

  NodeState& node_;
  std::optional<Slot> last_;
  std::uint64_t bytes_ = 0;
};

}  // namespace warren::replication
