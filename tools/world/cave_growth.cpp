// SPDX-License-Identifier: Apache-2.0
#include "tools/world/cave_growth.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "tools/world/cave_space.hpp"

namespace warren::world {
namespace {

constexpr double kStep_m = 1.8;      // in plan
constexpr double kSteepest = 0.5;    // 27 degrees; noise adds the rest
constexpr double kDeepest_m = 15.0;  // above and below the way in
constexpr double kPitRadius_m = 1.2;
constexpr int kShortestLoop = 16;  // edges
constexpr int kOwnKin = 6;         // edges within which passages may touch

struct Worm {
  std::uint32_t node = 0;
  double heading_rad = 0.0;
  double turn_rad = 0.0;
  double slope = 0.0;
  double half_width_m = 1.8;
  int steps_left = 30;
  Nodes trail;  // nodes of its own, latest last
};

Nodes united(const Nodes& a, const Nodes& b) {
  Nodes both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

class CaveGrowth {
 public:
  CaveGrowth(double length_m, const Random& random) : target_m_(length_m), random_(random) {}

  Network grow() {
    network_.add_node({Eigen::Vector3d::Zero(), 1.8}, 2.6);
    grid_.update();
    worms_.push_back({.steps_left = 60, .trail = {0}});
    // The bound keeps a cave that boxed itself in from trying forever.
    const auto most_tries = static_cast<std::int64_t>(kTriesPerMetre * target_m_);
    for (std::int64_t tries = 0; length_m_ < target_m_ && tries < most_tries; ++tries) {
      if (worms_.empty()) revive();
      const std::size_t turn = random_.below(static_cast<std::uint32_t>(worms_.size()));
      if (!advance(worms_[turn])) worms_.erase(worms_.begin() + static_cast<std::ptrdiff_t>(turn));
    }
    for (const CaveSpace::Chamber& chamber : space_.chambers)
      network_.graph.nodes[chamber.node].half_width_m = chamber.radius_m;
    return std::move(network_);
  }

 private:
  static constexpr double kTriesPerMetre = 100.0;

  bool advance(Worm& worm);
  void wander(Worm& worm);
  std::optional<PassageGraph::Node> free_place(Worm& worm);
  bool meet(const Worm& worm);
  bool can_join(const Worm& worm, std::uint32_t other) const;
  void branch(const Worm& worm);
  void revive();
  void maybe_widen(std::uint32_t node);
  void maybe_sink_pit(std::uint32_t node, double radius_m);
  void add_edge_to(const Worm& worm, std::uint32_t node);

  double target_m_;
  Random random_;
  CaveSpace space_;
  Network& network_ = space_.network;
  NodeGrid& grid_ = space_.grid;
  double length_m_ = 0.0;
  std::vector<Worm> worms_;
};

// One step on; false if the worm's life is over.
bool CaveGrowth::advance(Worm& worm) {
  if (worm.steps_left-- <= 0) return false;
  wander(worm);
  const auto place = free_place(worm);
  if (!place) {
    meet(worm);
    return false;
  }
  const std::uint32_t next =
      network_.add_node(*place, random_.uniform(1.1, 1.6) * place->half_width_m);
  network_.height_m[next] = std::max(network_.height_m[next], 2.2);
  add_edge_to(worm, next);
  worm.node = next;
  worm.trail.push_back(next);
  if (worm.trail.size() > kOwnKin + 1) worm.trail.erase(worm.trail.begin());
  maybe_widen(next);
  if (random_.chance(0.4) && meet(worm)) return false;
  if (random_.chance(0.08)) branch(worm);
  return true;
}

void CaveGrowth::add_edge_to(const Worm& worm, std::uint32_t node) {
  network_.add_passage(worm.node, node);
  grid_.update();
  const auto& nodes = network_.graph.nodes;
  length_m_ += (nodes[node].position - nodes[worm.node].position).norm();
}

void CaveGrowth::wander(Worm& worm) {
  worm.turn_rad = std::clamp(0.7 * worm.turn_rad + 0.14 * random_.normal(), -0.4, 0.4);
  worm.heading_rad += worm.turn_rad;
  const double z = network_.graph.nodes[worm.node].position.z();
  const double homesick = -0.06 * z / kDeepest_m;
  worm.slope =
      std::clamp(0.9 * worm.slope + 0.12 * random_.normal() + homesick, -kSteepest, kSteepest);
  worm.half_width_m = std::clamp(worm.half_width_m + 0.15 * random_.normal(), 1.4, 2.6);
}

// Where the worm can go: ahead, or as little aside as there is room.
std::optional<PassageGraph::Node> CaveGrowth::free_place(Worm& worm) {
  const double sign = random_.chance(0.5) ? 1.0 : -1.0;
  const Nodes kin = grid_.hops_from(worm.node, kOwnKin);
  for (const double aside_rad : {0.0, 0.4, -0.4, 0.8, -0.8}) {
    const double heading_rad = worm.heading_rad + sign * aside_rad;
    const Eigen::Vector3d step(std::cos(heading_rad), std::sin(heading_rad), worm.slope);
    const Eigen::Vector3d place = network_.graph.nodes[worm.node].position + kStep_m * step;
    if (space_.is_over_pit(network_.graph.nodes[worm.node].position, place)) continue;
    if (space_.stranger_at(place, worm.half_width_m, kin)) continue;
    if (space_.tilts(place, worm.half_width_m, kin, worm.trail)) continue;
    worm.heading_rad = heading_rad;
    return PassageGraph::Node{place, worm.half_width_m};
  }
  return std::nullopt;
}

// A loop: the worm breaks into the nearest passage ahead that it can reach soundly.
bool CaveGrowth::meet(const Worm& worm) {
  constexpr double kLongest_m = 12.0;
  const Eigen::Vector3d here = network_.graph.nodes[worm.node].position;
  const auto close = grid_.hops_from(worm.node, kShortestLoop);
  std::vector<std::pair<double, std::uint32_t>> others;
  for (const std::uint32_t other : grid_.within(here, kLongest_m))
    if (!std::binary_search(close.begin(), close.end(), other))
      others.emplace_back((network_.graph.nodes[other].position - here).norm(), other);
  std::sort(others.begin(), others.end());
  for (const auto& [length_m, other] : others) {
    if (!can_join(worm, other)) continue;
    network_.join(worm.node, other);
    grid_.update();
    length_m_ += length_m;
    return true;
  }
  return false;
}

bool CaveGrowth::can_join(const Worm& worm, std::uint32_t other) const {
  const Eigen::Vector3d here = network_.graph.nodes[worm.node].position;
  const Eigen::Vector3d way = network_.graph.nodes[other].position - here;
  const Eigen::Vector3d ahead(std::cos(worm.heading_rad), std::sin(worm.heading_rad), 0.0);
  if (way.dot(ahead) < 0.3 * way.norm()) return false;
  if (std::abs(way.z()) > kSteepest * way.head<2>().norm()) return false;
  if (space_.is_over_pit(here, here + way)) return false;
  const auto own = grid_.hops_from(worm.node, kOwnKin);
  const auto theirs = grid_.hops_from(other, kOwnKin);
  // Neither end may run beside a floor of another height, nor the way break into a third passage.
  for (int fifth = 1; fifth < 5; ++fifth) {
    const double t = 0.2 * fifth;
    const Eigen::Vector3d place = here + t * way;
    if (space_.tilts(place, worm.half_width_m, theirs, {other}) ||
        space_.tilts(place, worm.half_width_m, own, worm.trail) ||
        space_.stranger_at(place, worm.half_width_m, united(own, theirs)))
      return false;
  }
  return true;
}

void CaveGrowth::branch(const Worm& worm) {
  Worm other = worm;
  const double aside_rad = random_.uniform(0.9, 1.7);
  other.heading_rad += random_.chance(0.5) ? aside_rad : -aside_rad;
  other.turn_rad = 0.0;
  // In the plane of the floor that it leaves.
  other.slope *= std::cos(aside_rad);
  other.trail = {worm.node};
  other.half_width_m *= random_.uniform(0.75, 1.0);
  other.steps_left = static_cast<int>(8 + random_.below(50));
  worms_.push_back(other);
}

void CaveGrowth::revive() {
  Worm worm;
  worm.node = random_.below(static_cast<std::uint32_t>(network_.graph.nodes.size()));
  // A pit's bottom leads nowhere.
  for (const std::uint32_t edge : grid_.edges_of(worm.node))
    if (!network_.graph.edges[edge].walkable && network_.graph.edges[edge].to == worm.node)
      worm.node = network_.graph.edges[edge].from;
  worm.trail = {worm.node};
  worm.heading_rad = random_.uniform(-std::numbers::pi, std::numbers::pi);
  worm.steps_left = static_cast<int>(10 + random_.below(50));
  worms_.push_back(worm);
}

// A chamber now and then, the first within the first 40 m.
void CaveGrowth::maybe_widen(std::uint32_t node) {
  const bool is_due = space_.chambers.empty() && length_m_ > std::min(24.0, target_m_ / 3.0);
  if (!is_due && !random_.chance(0.05)) return;
  const Eigen::Vector3d place = network_.graph.nodes[node].position;
  const double radius_m = random_.uniform(3.5, 6.5);
  for (const CaveSpace::Chamber& other : space_.chambers)
    if ((network_.graph.nodes[other.node].position - place).norm() < 30.0) return;
  if (space_.stranger_at(place, radius_m, grid_.hops_from(node, kOwnKin))) return;
  space_.chambers.push_back({node, radius_m});
  // The passages there keep their width, or they would open like funnels; a chamber is air of its
  // own.
  const Passage::End hall{place, radius_m, random_.uniform(1.0, 1.3) * radius_m};
  network_.passages.push_back({hall, hall});
  maybe_sink_pit(node, radius_m);
}

// Beside the way, where nothing lies below.
void CaveGrowth::maybe_sink_pit(std::uint32_t node, double radius_m) {
  if (space_.chambers.size() > 1 && random_.chance(0.4)) return;
  const double depth_m = random_.uniform(3.0, 6.0);
  const Eigen::Vector3d place = network_.graph.nodes[node].position;
  for (int attempt = 0; attempt < 8; ++attempt) {
    const double azimuth_rad = random_.uniform(-std::numbers::pi, std::numbers::pi);
    const double away_m = 0.55 * radius_m + 0.2;
    const Eigen::Vector3d aside(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    Eigen::Vector3d bottom = place + away_m * aside;
    if (grid_.to_path_m(bottom, 4.0) < kPitRadius_m + CaveSpace::kBrink_m) continue;
    bottom.z() -= depth_m;
    if (space_.stranger_at(bottom, kPitRadius_m + 1.0, grid_.hops_from(node, kOwnKin))) continue;
    network_.shafts.push_back({bottom, place.z() + 1.0, kPitRadius_m});
    const std::uint32_t low = network_.add_node({bottom, kPitRadius_m}, depth_m);
    network_.graph.add_edge(node, low, false);
    grid_.update();
    return;
  }
}

}  // namespace

Network grow_cave(double length_m, Random random) { return CaveGrowth(length_m, random).grow(); }

}  // namespace warren::world
