// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "daemon/replication/node_state.hpp"
#include "daemon/replication/pulling.hpp"

namespace warren::replication {

struct WalkCounts {
  std::uint64_t differences = 0;   // found at a revision that both held whole
  std::uint64_t regions = 0;       // that differed, and were forgotten and pulled again
  std::uint64_t given_up = 0;      // it kept on differing: somebody alters data, or the memory does
  std::optional<MemberId> member;  // the last that differed
};

// Equal revisions must have equal digests. Where the provider's differs from ours, its regions are
// compared with ours, and ours that differ are forgotten and pulled again: the provider is nearer
// to the origin. Whether it tells the truth only the origin's digest shows.
class DigestWalk {
 public:
  static constexpr std::uint64_t kRepairsMax = 3;  // per layer and revision
  static constexpr std::size_t kAnswersDueMax = 8;

  DigestWalk(NodeState& node, Pulling& pulling) : node_(node), pulling_(pulling) {}

  // Compares, if both hold the whole layer at one revision.
  void look(const HeldLayer& layer);
  void on_question(Peer& from, const DigestQuestion& question);
  void on_answer(Peer& from, const DigestAnswer& answer);

  std::optional<mesh::MapSource::Packet> next_for(Peer& to, std::size_t limit);
  void on_lost(Peer& peer, const DigestSent& sent);

  WalkCounts counts_of(Slot slot) const;

 private:
  struct Walk {
    MemberId member;
    Revision revision;
    RegionOrdinal next = 0;
    std::vector<RegionOrdinal> differing;
    bool under_way = false;
    std::uint64_t repairs = 0;
  };
  void ask(Peer& peer, Slot theirs, const Walk& walk);
  void repair(HeldLayer& layer, Walk& walk);

  NodeState& node_;
  Pulling& pulling_;
  std::map<Slot, Walk> walks_;
  std::map<Slot, WalkCounts> counts_;
};

}  // namespace warren::replication
