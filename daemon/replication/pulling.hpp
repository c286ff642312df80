// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "daemon/replication/node_state.hpp"
#include "daemon/replication/provider_choice.hpp"

namespace warren::replication {

// How a copy gets its content.
struct Pull {
  std::optional<MemberId> provider;
  Hops hops = kNoWay;
  KeySet keys;        // wanted
  bool lost = false;  // the next wish says that something did not arrive
  int fruitless = 0;  // wishes for what did not come, without an answer
  MeshTime asked = MeshTime::min();
  MeshTime progress = MeshTime::min();
  std::map<MemberId, MeshTime> idle_until;  // members that did not answer
};

// The subscriber's side: hears what neighbours hold, chooses for every layer one of them, and asks
// it for what is lacking, once; ticks then follow by themselves. It asks again when something went
// astray.
class Pulling {
 public:
  explicit Pulling(NodeState& node) : node_(node) {}

  // The layer it was about, if it is held here.
  const HeldLayer* on_announcement(Peer& from, Slot slot, std::span<const std::uint8_t> bytes);
  // The layer it was for, if it was for one that is held.
  HeldLayer* on_diff(Peer& from, const DiffMessage& message);
  void on_up(Peer& peer);
  void on_down() { choose_ = true; }
  void on_restarted(Peer& peer);
  // This node is there, in the fleet frame.
  void on_position(const Eigen::Vector3d& position_fleet);

  // Chooses providers, and looks after idle ones.
  void advance();
  MeshTime next_deadline() const;

  // What the member has to be told of our wishes.
  std::optional<mesh::MapSource::Packet> next_for(Peer& to, std::size_t limit);
  void on_acknowledged(const WishesSent& sent);
  void on_lost(Peer& peer, const WishesSent& sent);

  const Pull* find(const HeldLayer& layer) const;
  // Asks for everything again, as after a gap.
  void ask_again(const HeldLayer& layer);

 private:
  static constexpr Duration kWatchEvery = std::chrono::seconds(1);

  std::vector<Candidate> candidates(const HeldLayer& layer, const Pull& pull) const;
  void choose(HeldLayer& layer);
  void choose_all();
  void watch(HeldLayer& layer, Pull& pull);
  void tell(MemberId member, Slot slot);
  KeySet keys_of(const HeldLayer& layer) const;
  Wish wish_for(const Peer& to, const HeldLayer& layer, Slot theirs);
  void on_gap(const HeldLayer& layer, const Peer& provider);
  void leave_behind(HeldLayer& layer);
  void make_room(HeldLayer& layer);

  NodeState& node_;
  std::map<Slot, Pull> pulls_;  // by our slot
  bool choose_ = false;
  MeshTime watch_at_ = kNever;
  std::uint64_t wishes_ = 0;
  std::optional<Eigen::Vector3d> position_fleet_;
};

}  // namespace warren::replication
