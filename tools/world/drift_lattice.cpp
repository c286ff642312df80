// SPDX-License-Identifier: Apache-2.0
#include "tools/world/drift_lattice.hpp"

#include <map>
#include <set>
#include <utility>

#include "tools/world/noise.hpp"

namespace warren::world {
namespace {

using Place = std::pair<int, int>;  // pitches

class Digger {
 public:
  Digger(Network& network, std::uint32_t from, const DriftLattice& settings, const Random& random)
      : network_(network),
        settings_(settings),
        random_(random),
        relief_seed_(random_.next()),
        origin_(network.graph.nodes[from].position) {
    settle({0, 0}, from);
  }

  std::vector<std::uint32_t> dig() {
    double length_m = 0.0;
    while (length_m < settings_.length_m && !faces_.empty()) {
      const std::uint32_t pick = random_.below(static_cast<std::uint32_t>(faces_.size()));
      const auto [from, to] = faces_[pick];
      faces_.erase(faces_.begin() + pick);
      if (advance(from, to)) length_m += settings_.pitch_m;
    }
    return std::move(junctions_);
  }

 private:
  void settle(const Place& place, std::uint32_t node) {
    node_at_[place] = node;
    junctions_.push_back(node);
    for (const auto& [dx, dy] : {Place{1, 0}, Place{0, 1}, Place{-1, 0}, Place{0, -1}}) {
      const Place next{place.first + dx, place.second + dy};
      if (settings_.may_lie({next.first, next.second})) faces_.emplace_back(place, next);
    }
  }

  bool advance(const Place& from, const Place& to) {
    const auto there = node_at_.find(to);
    if (there == node_at_.end()) {
      const PassageGraph::Node node{position_of(to), settings_.half_width_m};
      settle(to, network_.add_way(node_at_[from], node, settings_.height_m));
    } else if (dug_.contains({to, from}) || !random_.chance(settings_.loop_share)) {
      return false;
    } else {
      network_.join(node_at_[from], there->second);
    }
    dug_.emplace(from, to);
    return true;
  }

  Eigen::Vector3d position_of(const Place& place) const {
    const Eigen::Vector3d level(place.first * settings_.pitch_m, place.second * settings_.pitch_m,
                                0.0);
    // Off the lattice points, where the noise is zero.
    const Eigen::Vector3d sample(0.4 * place.first + 0.31, 0.4 * place.second + 0.17, 0.5);
    return origin_ + level +
           settings_.relief_m * gradient_noise(sample, relief_seed_) * Eigen::Vector3d::UnitZ();
  }

  Network& network_;
  const DriftLattice& settings_;
  Random random_;
  std::uint64_t relief_seed_;
  Eigen::Vector3d origin_;
  std::map<Place, std::uint32_t> node_at_;
  std::set<std::pair<Place, Place>> dug_;
  std::vector<std::pair<Place, Place>> faces_;  // where digging may go on
  std::vector<std::uint32_t> junctions_;
};

}  // namespace

std::vector<std::uint32_t> dig_lattice(Network& network, std::uint32_t from,
                                       const DriftLattice& settings, Random random) {
  return Digger(network, from, settings, random).dig();
}

}  // namespace warren::world
