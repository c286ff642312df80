// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tests/sim/ledger.hpp"
#include "tests/sim/sim_source.hpp"
#include "tests/sim/upper.hpp"
#include "tools/link/link_model.hpp"
#include "transport/endpoint/endpoint.hpp"

namespace warren::mesh::sim {

// Faults of the code under test, planted at its border, that the ledger must find.
enum class Planted : std::uint8_t {
  kNone,
  kParcelTwice,     // a parcel is handed on twice
  kFragmentLost,    // a parcel never becomes whole
  kNonceReused,     // a number is used for two packets
  kTelemetryStale,  // an old value is handed on
  kLeak,            // memory grows
  kStarved,         // a class is never sent
};

// One node: an endpoint, the layers around it and what they have stored.
struct SimNode {
  std::uint32_t id = 0;
  std::uint32_t life = 0;
  std::unique_ptr<Endpoint> endpoint;  // none: switched off
  std::unique_ptr<SimSource> source;
  std::vector<std::uint8_t> store;
  Duration clock_offset{};             // its clock is ahead of the simulation's by so much
  std::vector<MeshAddress> addresses;  // by interface
  std::vector<BootId> boots;           // of all its lives, the latest first
  std::uint64_t next_number = 1;       // of parcels, urgent messages
  std::uint64_t telemetry_number = 1;
  // What came last, for measurements.
  std::optional<MeshTime> first_arrival;
  std::vector<Duration> urgent_latency;
  std::vector<Duration> telemetry_latency;
  std::map<std::uint32_t, std::size_t> members_up;  // ups seen
  std::uint64_t polls = 0;
};

// N endpoints in virtual time on networks made of the link model: one seed, one outcome.
class Simulation {
 public:
  struct Config {
    std::size_t nodes = 2;
    std::vector<LinkModelConfig> networks = {{}};  // each node has an interface in each
    std::uint64_t seed = 1;
    InterfaceConfig interface;            // of every node; with `seeds` empty
    bool seeds_instead_of_group = false;  // the network carries no group packets
    std::size_t members_max = 256;
    std::size_t memory_max = 40'000'000;
    Planted planted = Planted::kNone;
    Upper* upper = nullptr;       // outlives the simulation; none: nodes send what they are told to
    bool check_datagrams = true;  // opens each and keeps its digest
  };

  explicit Simulation(const Config& config);
  ~Simulation();

  MeshTime now() const { return now_; }
  SimNode& node(std::size_t index) { return nodes_[index]; }
  std::size_t nodes() const { return nodes_.size(); }
  std::size_t networks() const { return networks_.size(); }
  LinkModel& network(std::size_t index = 0) { return *networks_[index]; }
  Ledger& ledger() { return ledger_; }

  void at(MeshTime when, std::function<void()> action);
  void run_until(MeshTime end) {
    run_until(end, [] { return false; });
  }
  // True: it was done in time.
  bool run_until(MeshTime end, const std::function<bool()>& done);

  void start(std::size_t index);
  void stop(std::size_t index);  // as by kill -9: what the store does not have is lost
  void lose_store(std::size_t index);
  void change_address(std::size_t index, std::size_t interface);
  void touch(std::size_t index) { changed_[index] = true; }  // it is asked for what it has to do
  void step_clock(std::size_t index, Duration ahead);

  bool send_parcel(std::size_t from, std::size_t to, ParcelClass priority, std::size_t bytes);
  void send_urgent(std::size_t from, std::optional<std::size_t> to);
  void set_telemetry(std::size_t from, std::uint16_t key, std::size_t bytes = 100);
  void add_map(std::size_t from, std::size_t to, MapClass priority, std::uint64_t bytes);
  void add_group(std::size_t from, std::uint64_t bytes);  // on all interfaces
  // Sends bytes as if from this address: recorded or forged packets.
  void inject(std::size_t to, std::size_t interface, const MeshAddress& from,
              std::vector<std::uint8_t> bytes);
  // Every datagram that is sent, before the network.
  std::function<void(std::size_t from, const Datagram& datagram)> on_sent;

 private:
  MeshTime local(const SimNode& node) const { return now_ + node.clock_offset; }
  std::size_t index_of(const SimNode& node) const { return node.id - 1; }
  void pump(SimNode& node);
  void send(SimNode& node, const Datagram& datagram);
  std::optional<BootId> sealed_for(std::size_t station, const Datagram& datagram);
  void on_event(SimNode& node, MeshEvent&& event);
  void on_parcel(SimNode& node, const ParcelArrived& parcel);
  void deliver();
  MeshTime next_time() const;
  bool has_turn(std::size_t index) const;
  void check_memory();

  Config config_;
  MeshTime now_{};
  std::shared_ptr<const KeySchedule> keys_;
  Ledger ledger_;
  std::vector<std::unique_ptr<LinkModel>> networks_;
  std::vector<SimNode> nodes_;
  std::map<MeshAddress, std::size_t> by_address_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Key> pair_keys_;  // by sender, receiver
  std::multimap<MeshTime, std::function<void()>> actions_;
  std::vector<bool> changed_;                  // nodes to be pumped
  std::map<std::uint64_t, MeshTime> sent_at_;  // of urgent and telemetry, by from and number
  std::uint32_t addresses_given_ = 0;
  MeshTime memory_checked_{};
  std::uint64_t boots_ = 0;
  std::size_t planted_leak_ = 0;
  std::vector<std::uint8_t> planted_telemetry_;
};

}  // namespace warren::mesh::sim
