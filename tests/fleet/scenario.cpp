// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/scenario.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <utility>

#include "transport/flow/seconds.hpp"

namespace warren::fleet_sim {
namespace {

using std::chrono::seconds;

double seconds_of(MeshTime time) { return mesh::in_seconds(time.time_since_epoch()); }

// Who hears whom.
enum class Shape : std::uint8_t { kCell, kLine, kStar };

class Scenario {
 public:
  Scenario(std::uint64_t seed, Planted planted) : random_(seed), fleet_(config(seed, planted)) {}
  Outcome run();

 private:
  FleetConfig config(std::uint64_t seed, Planted planted);
  replication::SharePolicy share();
  LinkConfig link(bool healed);
  bool hears(std::size_t a, std::size_t b) const;
  void set_links(bool healed);
  void set_pair(std::size_t a, std::size_t b, const LinkConfig& link);
  void plan_troubles();
  void plan_crash(MeshTime when);
  void plan_partition(MeshTime when, Duration length);
  void plan_strangers();
  void plan_messages();
  void heal();

  std::uint32_t nodes() { return static_cast<std::uint32_t>(fleet_.size()); }

  world::Random random_;
  std::size_t count_ = 0;
  Shape shape_ = Shape::kCell;
  double rate_bit_s_ = 0.0;
  double loss_ = 0.0;
  Duration delay_{};
  Duration trouble_{};
  bool near_ = false;
  bool healed_ = false;
  std::set<std::pair<std::size_t, std::size_t>> cut_;
  std::ostringstream story_;
  Fleet fleet_;
  std::vector<std::vector<std::uint8_t>> recorded_;
};

FleetConfig Scenario::config(std::uint64_t seed, Planted planted) {
  constexpr std::array kRates{50e3, 200e3, 1e6, 4e6};
  constexpr std::array kShapes{Shape::kCell, Shape::kCell, Shape::kLine, Shape::kStar};
  rate_bit_s_ = kRates[random_.below(kRates.size())];
  loss_ = random_.chance(0.3) ? 0.0 : random_.uniform(0.0, 0.4);
  delay_ = mesh::from_seconds(random_.uniform(0.001, 0.1));
  shape_ = kShapes[random_.below(kShapes.size())];
  trouble_ = mesh::from_seconds(random_.uniform(8.0, 25.0));
  count_ = 2 + random_.below(4);

  FleetConfig config;
  config.planted = planted;
  config.mesh.seed = seed;
  config.mesh.nodes = count_;
  config.mesh.check_datagrams = false;
  LinkModelConfig& network = config.mesh.networks.front();
  network.shared_airtime = random_.chance(0.4);
  config.mesh.interface.group_broadcast = random_.chance(0.3);
  network.queue.time = mesh::from_seconds(random_.uniform(0.05, 0.8));
  network.link = link(false);
  // Slow links carry little.
  config.walker.blocks_per_step = rate_bit_s_ < 100e3 ? 1 : 1 + random_.below(4);
  config.walker.voxels_per_block = 10 + random_.below(50);
  config.tick = mesh::from_seconds(rate_bit_s_ < 100e3 ? 2.0 : random_.uniform(0.3, 2.0));
  for (std::size_t i = 0; i < count_; ++i) {
    config.writes.push_back(i == 0 || random_.chance(0.6));
    config.shares.push_back(i == 0 ? replication::SharePolicy{} : share());
  }
  // In a line and in a star everything goes through those in the middle.
  if (shape_ != Shape::kCell) config.shares.assign(count_, {});
  story_ << count_ << " nodes in a "
         << (shape_ == Shape::kCell   ? "cell"
             : shape_ == Shape::kLine ? "line"
                                      : "star")
         << ", " << rate_bit_s_ / 1e3 << " kbit/s" << (network.shared_airtime ? " shared" : "")
         << (config.mesh.interface.group_broadcast ? ", broadcast" : "") << ", delay "
         << delay_.count() / 1000 << " ms, loss " << loss_;
  return config;
}

replication::SharePolicy Scenario::share() {
  using replication::Share;
  if (random_.chance(0.1)) return {.share = Share::kNothing};
  if (random_.chance(0.25)) {
    near_ = true;
    return {.share = Share::kNear, .radius_m = random_.uniform(2.0, 15.0)};
  }
  return {};
}

LinkConfig Scenario::link(bool healed) {
  LinkConfig link;
  link.capacity = Capacity(rate_bit_s_);
  link.delay = delay_;
  link.loss = loss_;
  if (healed) return link;
  if (random_.chance(0.3)) link.burst_loss = BurstLoss{random_.uniform(0.02, 0.3), 8.0};
  if (random_.chance(0.3)) link.duplicate = random_.uniform(0.0, 0.1);
  if (random_.chance(0.3)) link.corrupt = random_.uniform(0.0, 0.05);
  if (random_.chance(0.3)) {
    link.reorder = random_.uniform(0.0, 0.1);
    link.reorder_by = mesh::from_seconds(random_.uniform(0.0, 0.05));
  }
  return link;
}

bool Scenario::hears(std::size_t a, std::size_t b) const {
  if (cut_.contains(std::minmax(a, b))) return false;
  if (shape_ == Shape::kLine) return a + 1 == b || b + 1 == a;
  if (shape_ == Shape::kStar) return a == 0 || b == 0;
  return true;
}

void Scenario::set_pair(std::size_t a, std::size_t b, const LinkConfig& link) {
  fleet_.mesh().network().set_link(fleet_.now(), static_cast<StationIndex>(a),
                                   static_cast<StationIndex>(b), link);
}

void Scenario::set_links(bool healed) {
  LinkConfig dead = link(true);
  dead.loss = 1.0;
  const LinkConfig alive = link(healed);
  for (std::size_t a = 0; a < count_; ++a) {
    for (std::size_t b = 0; b < count_; ++b) {
      if (a != b) set_pair(a, b, hears(a, b) ? alive : dead);
    }
  }
}

void Scenario::plan_crash(MeshTime when) {
  const std::size_t node = random_.below(nodes());
  const bool lost = random_.chance(0.25);
  const MeshTime again = when + mesh::from_seconds(random_.uniform(0.0, 6.0));
  story_ << "; " << seconds_of(when) << " s: node " << node + 1 << " crashes"
         << (lost ? " and loses its store" : "");
  fleet_.mesh().at(when, [=, this] {
    if (!fleet_.node(node).replication) return;
    fleet_.crash(node);
    if (lost) fleet_.lose_disk(node);
    fleet_.mesh().at(again, [=, this] {
      if (!fleet_.node(node).replication) fleet_.start(node);
    });
  });
}

void Scenario::plan_partition(MeshTime when, Duration length) {
  const std::size_t border = 1 + random_.below(nodes() - 1);
  story_ << "; " << seconds_of(when) << " s: nodes from " << border + 1 << " on are cut off";
  fleet_.mesh().at(when, [=, this] {
    for (std::size_t a = 0; a < border; ++a) {
      for (std::size_t b = border; b < count_; ++b) cut_.insert(std::minmax(a, b));
    }
    set_links(false);
  });
  fleet_.mesh().at(when + length, [=, this] {
    cut_.clear();
    if (!healed_) set_links(false);
  });
}

// What was sent, sent again later or to others, whole or with a bit flipped.
void Scenario::plan_strangers() {
  story_ << "; a stranger repeats what it hears";
  fleet_.mesh().on_sent = [this](std::size_t, const mesh::Datagram& datagram) {
    if (recorded_.size() < 2000) recorded_.push_back(datagram.bytes);
  };
  for (int i = 0; i < 100; ++i) {
    const MeshTime when(mesh::from_seconds(random_.uniform(1.0, seconds_of(MeshTime(trouble_)))));
    const std::size_t to = random_.below(nodes());
    const std::uint64_t draw = random_.next();
    fleet_.mesh().at(when, [=, this] {
      if (recorded_.empty()) return;
      auto bytes = recorded_[draw % recorded_.size()];
      if (draw >> 60 < 8) {
        std::uint8_t& byte = bytes[draw % bytes.size()];
        byte = static_cast<std::uint8_t>(byte ^ 1U << (draw >> 40) % 8);
      }
      fleet_.mesh().inject(to, 0, {{}, 7700}, std::move(bytes));
    });
  }
}

void Scenario::plan_messages() {
  for (std::uint32_t i = random_.below(10); i > 0; --i) {
    const MeshTime when(mesh::from_seconds(random_.uniform(0.5, seconds_of(MeshTime(trouble_)))));
    const std::size_t from = random_.below(nodes());
    std::optional<std::size_t> to;
    if (random_.chance(0.6)) to = (from + 1 + random_.below(nodes() - 1)) % nodes();
    const std::size_t bytes = random_.below(random_.chance(0.1) ? 20'000 : 500);
    fleet_.mesh().at(when, [=, this] { fleet_.post(from, to, bytes); });
  }
}

void Scenario::plan_troubles() {
  for (std::uint32_t i = random_.below(5); i > 0; --i) {
    const MeshTime when(mesh::from_seconds(random_.uniform(1.0, seconds_of(MeshTime(trouble_)))));
    const Duration length = mesh::from_seconds(random_.uniform(0.5, 12.0));
    const std::uint32_t kind = random_.below(3);
    if (kind == 0) {
      plan_crash(when);
    } else if (kind == 1) {
      plan_partition(when, length);
    } else {
      story_ << "; " << seconds_of(when) << " s: silence";
      fleet_.mesh().at(when, [=, this] { fleet_.mesh().network().set_silent(fleet_.now(), true); });
      fleet_.mesh().at(when + length,
                       [=, this] { fleet_.mesh().network().set_silent(fleet_.now(), false); });
    }
  }
  if (random_.chance(0.2)) plan_strangers();
}

void Scenario::heal() {
  fleet_.stop_writing();
  fleet_.mesh().network().set_silent(fleet_.now(), false);
  cut_.clear();
  healed_ = true;
  set_links(true);
  for (std::size_t i = 0; i < fleet_.size(); ++i) {
    if (!fleet_.node(i).replication) fleet_.start(i);
  }
}

Outcome Scenario::run() {
  set_links(false);
  for (std::size_t i = 0; i < fleet_.size(); ++i) {
    const bool late = random_.chance(0.2);
    const MeshTime when(
        mesh::from_seconds(random_.uniform(0.0, late ? seconds_of(MeshTime(trouble_)) : 1.0)));
    fleet_.mesh().at(when, [=, this] {
      if (!fleet_.node(i).replication) fleet_.start(i);
    });
  }
  plan_messages();
  plan_troubles();
  fleet_.mesh().run_until(MeshTime(trouble_));
  heal();
  const MeshTime healed = fleet_.now();
  MeshTime looked = healed;
  std::optional<std::string> lacking = "not looked";
  const Duration limit = seconds(rate_bit_s_ < 100e3 ? 240 : 90);
  fleet_.mesh().run_until(healed + limit, [&] {
    if (fleet_.now() < looked + std::chrono::milliseconds(500)) return false;
    looked = fleet_.now();
    lacking = fleet_.lacking();
    if (!lacking) lacking = fleet_.undelivered();
    return !lacking.has_value();
  });
  Outcome outcome;
  outcome.healing_s = seconds_of(fleet_.now()) - seconds_of(healed);
  outcome.failures = fleet_.failures();
  if (lacking) outcome.failures.push_back("after heal and quiet: " + *lacking);
  for (const auto& failure : fleet_.mesh().ledger().failures()) outcome.failures.push_back(failure);
  if (const auto beyond = fleet_.beyond_bounds()) outcome.failures.push_back(*beyond);
  outcome.packets = fleet_.packets();
  // On slow links the last announcements and their repetitions take longer.
  fleet_.mesh().run_until(fleet_.now() + seconds(rate_bit_s_ < 100e3 ? 100 : 40));
  const std::uint64_t before = fleet_.said_bytes();
  fleet_.mesh().run_until(fleet_.now() + seconds(60));
  outcome.quiet_bytes = fleet_.said_bytes() - before;
  outcome.story = story_.str();
  outcome.loss = loss_;
  outcome.near = near_;
  outcome.seconds = seconds_of(fleet_.now());
  return outcome;
}

}  // namespace

Outcome run_scenario(std::uint64_t seed, Planted planted) { return Scenario(seed, planted).run(); }

}  // namespace warren::fleet_sim
