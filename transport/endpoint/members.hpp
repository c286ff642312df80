// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "transport/endpoint/peer.hpp"

namespace warren::mesh {

// The peers by member id and by the boot they run in. Lives that have ended are remembered for a
// while, so that their packets are known for what they are.
class Members {
 public:
  static constexpr std::size_t kRetiredMax = 1024;
  using ById = std::map<MemberId, std::unique_ptr<Peer>>;

  explicit Members(std::size_t members_max) : members_max_(members_max) {}

  Peer* find(MemberId id);
  Peer* find(BootId boot);
  bool is_retired(BootId boot) const { return retired_.contains(boot.bits); }
  bool full() const { return by_id_.size() >= members_max_; }
  // Precondition: not full(), no such member.
  Peer& add(std::unique_ptr<Peer> peer);
  // Its boot is not taken for one that has ended: it may come again.
  void remove(MemberId id);
  // The peer runs in this boot from now on: the session it had is over.
  void begin_session(Peer& peer, Session session);

  // In the order of ids.
  ById::const_iterator begin() const { return by_id_.begin(); }
  ById::const_iterator end() const { return by_id_.end(); }
  std::size_t size() const { return by_id_.size(); }

 private:
  void retire(BootId boot);

  std::size_t members_max_;
  ById by_id_;
  std::unordered_map<std::uint64_t, Peer*> by_boot_;
  std::unordered_set<std::uint64_t> retired_;
  std::deque<std::uint64_t> retired_order_;  // oldest first
};

}  // namespace warren::mesh
