// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "tools/world/random.hpp"
#include "transport/flow/seconds.hpp"

namespace warren::mesh::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Everything about one run; its members are drawn in this order.
class Scenario {
 public:
  Scenario(std::uint64_t seed, Planted planted)
      : random_(seed), simulation_(config(seed, planted)) {}

  ScenarioOutcome run();

 private:
  static constexpr double kLoadSeconds = 4.0;  // of a link's rate, in all

  Simulation::Config config(std::uint64_t seed, Planted planted);
  LinkConfig impaired();
  LinkConfig healed() const;
  void set_all(const LinkConfig& link);
  void plan_load();
  void plan_troubles();
  void plan_restart(MeshTime when);
  void heal();
  double queued_bytes();
  Duration theoretical();
  std::uint64_t open_bytes(std::size_t node) { return simulation_.node(node).source->open_bytes(); }

  world::Random random_;
  double rate_bit_s_ = 0.0;
  double loss_ = 0.0;
  Duration delay_{};
  bool shared_ = false;
  bool small_ = false;
  bool seeds_ = false;
  Duration trouble_{};
  std::ostringstream story_;
  Simulation simulation_;
};

Simulation::Config Scenario::config(std::uint64_t seed, Planted planted) {
  constexpr std::array kRates{50e3, 200e3, 1e6, 1e6, 4e6};
  rate_bit_s_ = kRates[random_.below(kRates.size())];
  loss_ = random_.chance(0.3) ? 0.0 : random_.uniform(0.0, 0.25);
  delay_ = from_seconds(random_.uniform(0.001, 0.15));
  shared_ = random_.chance(0.4);
  small_ = random_.chance(0.1);
  trouble_ = from_seconds(random_.uniform(6.0, 16.0));

  Simulation::Config config;
  config.seed = seed;
  config.planted = planted;
  config.nodes = 2 + random_.below(3);
  config.networks = std::vector<LinkModelConfig>(random_.chance(0.2) ? 2 : 1);
  seeds_ = random_.chance(0.15);
  config.seeds_instead_of_group = seeds_;
  for (LinkModelConfig& network : config.networks) {
    network.shared_airtime = shared_;
    network.queue.time = from_seconds(random_.uniform(0.05, 0.8));
    network.queue.packets = 5 + random_.below(200);
    network.link = impaired();
  }
  story_ << config.nodes << " nodes, " << config.networks.size() << " networks, "
         << rate_bit_s_ / 1e3 << " kbit/s" << (shared_ ? " shared" : "") << ", delay "
         << delay_.count() / 1000 << " ms, loss " << loss_ << (small_ ? ", small packets" : "")
         << (config.seeds_instead_of_group ? ", seeds" : "");
  return config;
}

LinkConfig Scenario::healed() const {
  LinkConfig link;
  link.capacity = Capacity(rate_bit_s_);
  link.delay = delay_;
  link.loss = loss_;
  if (small_) link.mtu_bytes = 600;
  return link;
}

LinkConfig Scenario::impaired() {
  LinkConfig link = healed();
  if (random_.chance(0.5)) link.jitter = from_seconds(random_.uniform(0.0, 0.02));
  link.jitter_reorders = random_.chance(0.3);
  if (random_.chance(0.3)) link.loss = random_.uniform(0.0, 0.5);
  if (random_.chance(0.3)) link.burst_loss = BurstLoss{random_.uniform(0.02, 0.3), 8.0};
  if (random_.chance(0.3)) link.duplicate = random_.uniform(0.0, 0.1);
  if (random_.chance(0.3)) link.corrupt = random_.uniform(0.0, 0.05);
  if (random_.chance(0.3)) {
    link.reorder = random_.uniform(0.0, 0.1);
    link.reorder_by = from_seconds(random_.uniform(0.0, 0.05));
  }
  return link;
}

void Scenario::set_all(const LinkConfig& link) {
  const auto nodes = static_cast<StationIndex>(simulation_.nodes());
  for (std::size_t k = 0; k < simulation_.networks(); ++k) {
    for (StationIndex from = 0; from < nodes; ++from) {
      for (StationIndex to = 0; to < nodes; ++to) {
        if (from != to) simulation_.network(k).set_link(simulation_.now(), from, to, link);
      }
    }
  }
}

void Scenario::plan_load() {
  double left = rate_bit_s_ / 8.0 * kLoadSeconds * random_.uniform(0.2, 1.0);
  const auto moment = [&] {
    return MeshTime(from_seconds(random_.uniform(0.0, in_seconds(trouble_))));
  };
  const auto nodes = static_cast<std::uint32_t>(simulation_.nodes());
  while (left > 0.0) {
    const std::size_t from = random_.below(nodes);
    const std::size_t to = (from + 1 + random_.below(nodes - 1)) % nodes;
    const double most = std::min(left, random_.chance(0.1) ? 200e3 : 20e3);
    const auto bytes = kStampBytes + static_cast<std::size_t>(random_.uniform(0.0, most));
    left -= static_cast<double>(bytes) + 500.0;
    const MeshTime when = moment();
    if (random_.chance(0.3)) {
      const MapClass priority = random_.chance(0.5) ? MapClass::kFresh : MapClass::kBacklog;
      simulation_.at(when, [=, this] { simulation_.add_map(from, to, priority, bytes); });
    } else {
      const ParcelClass priority =
          random_.chance(0.2) ? ParcelClass::kControl : ParcelClass::kMessage;
      simulation_.at(when, [=, this] { simulation_.send_parcel(from, to, priority, bytes); });
    }
  }
  for (std::uint32_t i = random_.below(20); i > 0; --i) {
    const std::size_t from = random_.below(nodes);
    simulation_.at(moment(), [=, this] { simulation_.send_urgent(from, std::nullopt); });
  }
  for (std::uint32_t i = random_.below(60); i > 0; --i) {
    const std::size_t from = random_.below(nodes);
    const auto key = static_cast<std::uint16_t>(random_.below(3));
    simulation_.at(moment(), [=, this] { simulation_.set_telemetry(from, key); });
  }
}

void Scenario::plan_restart(MeshTime when) {
  const std::size_t node = random_.below(static_cast<std::uint32_t>(simulation_.nodes()));
  const bool lost = random_.chance(0.2);
  const MeshTime again = when + from_seconds(random_.uniform(0.0, 3.0));
  story_ << "; " << in_seconds(when.time_since_epoch()) << " s: node " << node << " restarts"
         << (lost ? " without its store" : "");
  simulation_.at(when, [=, this] {
    if (!simulation_.node(node).endpoint) return;
    simulation_.stop(node);
    if (lost) simulation_.lose_store(node);
    simulation_.at(again, [=, this] {
      if (!simulation_.node(node).endpoint) simulation_.start(node);
    });
  });
}

void Scenario::plan_troubles() {
  const auto nodes = static_cast<std::uint32_t>(simulation_.nodes());
  for (std::uint32_t i = random_.below(5); i > 0; --i) {
    const MeshTime when(from_seconds(random_.uniform(0.5, in_seconds(trouble_))));
    const std::size_t node = random_.below(nodes);
    const auto other = static_cast<StationIndex>((node + 1 + random_.below(nodes - 1)) % nodes);
    const std::size_t network = random_.below(static_cast<std::uint32_t>(simulation_.networks()));
    const Duration length = from_seconds(random_.uniform(0.2, 12.0));
    std::uint32_t kind = random_.below(5);
    // Two that are known by old addresses only cannot find each other.
    if (kind == 1 && seeds_) kind = 4;
    if (kind == 0) {
      plan_restart(when);
    } else if (kind == 1) {
      story_ << "; address";
      simulation_.at(when, [=, this] { simulation_.change_address(node, network); });
    } else if (kind == 2) {
      story_ << "; clock";
      simulation_.at(when, [=, this] { simulation_.step_clock(node, length * 5); });
    } else if (kind == 3) {
      story_ << "; one way dead";
      LinkConfig dead = healed();
      dead.loss = 1.0;
      simulation_.at(when, [=, this] {
        simulation_.network(network).set_link(simulation_.now(), static_cast<StationIndex>(node),
                                              other, dead);
      });
    } else {
      story_ << "; silence";
      simulation_.at(
          when, [=, this] { simulation_.network(network).set_silent(simulation_.now(), true); });
      simulation_.at(when + length, [=, this] {
        simulation_.network(network).set_silent(simulation_.now(), false);
      });
    }
  }
}

// What stands in queues goes first, whether it is of use still or not.
double Scenario::queued_bytes() {
  double most = 0.0;
  for (std::size_t k = 0; k < simulation_.networks(); ++k) {
    double all = 0.0;
    for (std::size_t i = 0; i < simulation_.nodes(); ++i) {
      const auto station = static_cast<StationIndex>(i);
      const auto bytes = static_cast<double>(simulation_.network(k).queued_bytes(station));
      all = shared_ ? all + bytes : std::max(all, bytes);
    }
    most = std::max(most, all);
  }
  return most;
}

// Of what is left, if every packet were full and none were sent in vain.
Duration Scenario::theoretical() {
  const std::size_t nodes = simulation_.nodes();
  std::vector<double> by_sender(nodes);
  for (const Ledger::Parcel& parcel : simulation_.ledger().parcels()) {
    if (parcel.excused || parcel.arrived) continue;
    by_sender[parcel.from - 1] += static_cast<double>(parcel.bytes) + 100.0;
  }
  for (std::size_t i = 0; i < nodes; ++i) by_sender[i] += static_cast<double>(open_bytes(i));
  double bytes = 0.0;
  for (const double sender : by_sender) bytes = shared_ ? bytes + sender : std::max(bytes, sender);
  // Of a packet of 1428 bytes, or 300 on the slowest links, so much is payload. One of 90 bytes
  // acknowledges two that arrived; on a shared medium that takes the same air.
  const bool short_packets = small_ || rate_bit_s_ < 100e3;
  const double payload = short_packets ? 0.75 : 0.92;
  const double acknowledged = !shared_ ? 0.0 : short_packets ? 0.08 : 0.035;
  // Beacons of each node take 900 bit/s of the air that it sends in.
  const double rate = rate_bit_s_ - 900.0 * static_cast<double>(shared_ ? nodes : 1);
  const double sent = bytes / payload * (1.0 / (1.0 - loss_) + acknowledged) + queued_bytes();
  // What was known of the rate is of the time of troubles. Nobody finds it faster than by doubling
  // in each round trip what the first eight packets of 400 bytes were.
  const double trip_s = 2.0 * in_seconds(delay_);
  const double doublings =
      std::log2(std::max(std::min(bytes, rate_bit_s_ / 8.0 * trip_s) / 3200.0, 1.0));
  return from_seconds(sent * 8.0 / rate + doublings * trip_s) + 10 * delay_;
}

void Scenario::heal() {
  for (std::size_t k = 0; k < simulation_.networks(); ++k) {
    simulation_.network(k).set_silent(simulation_.now(), false);
  }
  set_all(healed());
  for (std::size_t i = 0; i < simulation_.nodes(); ++i) {
    if (!simulation_.node(i).endpoint) simulation_.start(i);
  }
}

ScenarioOutcome Scenario::run() {
  for (std::size_t i = 0; i < simulation_.nodes(); ++i) {
    simulation_.at(MeshTime(from_seconds(random_.uniform(0.0, 2.0))), [=, this] {
      if (!simulation_.node(i).endpoint) simulation_.start(i);
    });
  }
  plan_load();
  plan_troubles();
  const MeshTime healed_at = MeshTime(trouble_);
  simulation_.run_until(healed_at);
  heal();
  const Duration needed = theoretical();
  const Duration target = needed + needed / 4 + seconds(2);
  const Duration limit = 4 * needed + seconds(25);
  const auto finished = [&] {
    for (std::size_t i = 0; i < simulation_.nodes(); ++i) {
      if (simulation_.node(i).source->open_bytes() > 0) return false;
    }
    return simulation_.ledger().outstanding() == 0;
  };
  if (!simulation_.run_until(healed_at + limit, finished)) {
    std::ostringstream what;
    what << "not done " << in_seconds(limit)
         << " s after all was well: " << simulation_.ledger().outstanding() << " parcels with "
         << simulation_.ledger().outstanding_bytes() << " bytes";
    for (std::size_t i = 0; i < simulation_.nodes(); ++i) what << ", map " << open_bytes(i);
    const bool later = simulation_.run_until(healed_at + 5 * limit, finished);
    what << (later ? "; done later, after " : "; never done, not after ")
         << in_seconds(simulation_.now() - healed_at) << " s";
    simulation_.ledger().fail(healed_at + limit, what.str());
  }
  const Duration late = std::max(simulation_.now() - healed_at - target, Duration{});
  // Whatever comes twice comes soon.
  simulation_.run_until(simulation_.now() + seconds(3));
  return {simulation_.ledger().failures(), story_.str(),
          in_seconds(simulation_.now().time_since_epoch()), in_seconds(late)};
}

}  // namespace

ScenarioOutcome run_scenario(std::uint64_t seed, Planted planted) {
  return Scenario(seed, planted).run();
}

}  // namespace warren::mesh::sim
