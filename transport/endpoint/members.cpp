// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/members.hpp"

#include <cassert>
#include <utility>

namespace warren::mesh {

Peer* Members::find(MemberId id) {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second.get();
}

Peer* Members::find(BootId boot) {
  const auto found = by_boot_.find(boot.bits);
  return found == by_boot_.end() ? nullptr : found->second;
}

Peer& Members::add(std::unique_ptr<Peer> peer) {
  assert(!full());
  const MemberId id = peer->id;
  const auto [added, is_new] = by_id_.emplace(id, std::move(peer));
  assert(is_new);
  return *added->second;
}

void Members::remove(MemberId id) {
  const auto peer = by_id_.find(id);
  assert(peer != by_id_.end());
  if (peer->second->session) by_boot_.erase(peer->second->session->keys.peer().bits);
  by_id_.erase(peer);
}

void Members::begin_session(Peer& peer, Session session) {
  if (peer.session) retire(peer.session->keys.peer());
  by_boot_[session.keys.peer().bits] = &peer;
  peer.session.emplace(std::move(session));
}

void Members::retire(BootId boot) {
  by_boot_.erase(boot.bits);
  if (retired_order_.size() == kRetiredMax) {
    retired_.erase(retired_order_.front());
    retired_order_.pop_front();
  }
  retired_.insert(boot.bits);
  retired_order_.push_back(boot.bits);
}

}  // namespace warren::mesh
