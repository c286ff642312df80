// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/simulation.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "tools/world/random.hpp"
#include "transport/wire/envelope.hpp"

namespace warren::mesh::sim {
namespace {

// A driver that is asked more often than this for each packet loops.
constexpr std::uint64_t kPollsPerSecondMax = 40'000;
constexpr Duration kMemoryEvery = std::chrono::seconds(1);

}  // namespace

Simulation::Simulation(const Config& config) : config_(config), changed_(config.nodes) {
  Key fleet_key{};
  fleet_key[0] = 7;
  keys_ = std::make_shared<PresharedKeys>(fleet_key);
  world::Random random(config.seed);
  for (LinkModelConfig network : config_.networks) {
    network.stations = config_.nodes;
    network.seed = random.next();
    networks_.push_back(std::make_unique<LinkModel>(network));
  }
  nodes_.resize(config_.nodes);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].id = static_cast<std::uint32_t>(i + 1);
    nodes_[i].source = std::make_unique<SimSource>(nodes_[i].id, ledger_);
    if (config_.planted == Planted::kStarved) nodes_[i].source->starved = MapClass::kBacklog;
    nodes_[i].addresses.resize(networks_.size());
    for (std::size_t k = 0; k < networks_.size(); ++k) change_address(i, k);
  }
}

Simulation::~Simulation() = default;

void Simulation::change_address(std::size_t index, std::size_t interface) {
  MeshAddress& address = nodes_[index].addresses[interface];
  by_address_.erase(address);
  const std::uint32_t number = ++addresses_given_;
  address = {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 10, static_cast<std::uint8_t>(interface),
              static_cast<std::uint8_t>(number >> 8U), static_cast<std::uint8_t>(number)},
             7700};
  by_address_[address] = index;
}

void Simulation::start(std::size_t index) {
  SimNode& node = nodes_[index];
  assert(!node.endpoint);
  world::Random random(config_.seed * 1'000'003 + ++boots_);
  EndpointConfig config;
  config.self = {node.id};
  config.boot = {random.next()};
  node.boots.insert(node.boots.begin(), config.boot);
  config.random_seed = random.next();
  config.members_max = config_.members_max;
  for (std::size_t k = 0; k < networks_.size(); ++k) {
    config.interfaces.push_back(config_.interface);
    if (!config_.seeds_instead_of_group) continue;
    for (std::size_t other = 0; other < nodes_.size(); ++other) {
      if (other != index) config.interfaces.back().seeds.push_back(nodes_[other].addresses[k]);
    }
  }
  Upper* const upper = config_.upper;
  MapSource& source = upper != nullptr ? upper->on_start(local(node), index) : *node.source;
  node.endpoint = std::make_unique<Endpoint>(config, keys_, source);
  if (!node.store.empty()) {
    if (!node.endpoint->restore(node.store)) ledger_.fail(now_, "a store was not taken back");
    node.store = node.endpoint->save();
  }
  if (upper != nullptr) upper->on_started(local(node), index, *node.endpoint);
  changed_[index] = true;
}

void Simulation::stop(std::size_t index) {
  nodes_[index].endpoint.reset();
  nodes_[index].source->on_restart();
  if (config_.upper != nullptr) config_.upper->on_stop(index);
  ++nodes_[index].life;
}

void Simulation::lose_store(std::size_t index) {
  nodes_[index].store.clear();
  ledger_.on_store_lost(nodes_[index].id);
}

void Simulation::step_clock(std::size_t index, Duration ahead) {
  nodes_[index].clock_offset += ahead;
  changed_[index] = true;
}

void Simulation::at(MeshTime when, std::function<void()> action) {
  actions_.emplace(when, std::move(action));
}

std::optional<BootId> Simulation::sealed_for(std::size_t station, const Datagram& datagram) {
  const auto header = read_packet_header(datagram.bytes);
  if (!header || header->type != PacketType::kPair) return std::nullopt;
  for (const BootId boot : nodes_[station].boots) {
    const auto [key, is_new] = pair_keys_.try_emplace({header->sender.bits, boot.bits});
    if (is_new) key->second = keys_->pair_key(header->sender, boot);
    if (open(key->second, datagram.bytes)) return boot;
  }
  ledger_.fail(now_, "a packet was sealed for nobody");
  return std::nullopt;
}

void Simulation::send(SimNode& node, const Datagram& datagram) {
  const std::size_t index = index_of(node);
  if (on_sent) on_sent(index, datagram);
  StationIndex to = kEveryStation;
  if (!datagram.to.group) {
    const auto known = by_address_.find(datagram.to.address);
    // Nobody has the address any more: it takes its airtime and reaches nobody.
    to = known == by_address_.end() ? static_cast<StationIndex>(index)
                                    : static_cast<StationIndex>(known->second);
  }
  const bool checks = config_.check_datagrams;
  const auto receiver =
      !checks || to == kEveryStation || to == index ? std::nullopt : sealed_for(to, datagram);
  if (checks && to != index) ledger_.on_datagram(now_, receiver, datagram.bytes);
  if (config_.planted == Planted::kNonceReused && now_ > MeshTime(std::chrono::seconds(2))) {
    auto other = datagram.bytes;
    other.back() ^= 1U;
    ledger_.on_datagram(now_, receiver, other);
  }
  if (to == index || (datagram.to.group && config_.seeds_instead_of_group)) return;
  const std::size_t overhead = config_.interface.ip_header_bytes;
  networks_[datagram.to.interface]->send(now_, {static_cast<StationIndex>(index), to,
                                                datagram.bytes.size() + overhead, datagram.bytes});
}

void Simulation::pump(SimNode& node) {
  if (!node.endpoint) return;
  node.source->set_now(now_);
  if (config_.upper != nullptr) {
    config_.upper->on_turn(local(node), index_of(node), *node.endpoint);
  }
  while (const auto datagram = node.endpoint->poll_transmit(local(node))) send(node, *datagram);
  ++node.polls;
  bool events = false;
  while (auto event = node.endpoint->poll_event()) {
    on_event(node, std::move(*event));
    events = true;
  }
  // What the events caused, as receipts.
  if (events) changed_[index_of(node)] = true;
}

void Simulation::deliver() {
  for (std::size_t k = 0; k < networks_.size(); ++k) {
    while (auto delivery = networks_[k]->poll(now_)) {
      SimNode& node = nodes_[delivery->to];
      if (!node.endpoint) continue;
      const MeshPath from{static_cast<InterfaceIndex>(k), delivery->group,
                          nodes_[delivery->from].addresses[k]};
      node.endpoint->on_datagram(local(node), from, delivery->bytes);
      changed_[delivery->to] = true;
    }
  }
}

bool Simulation::has_turn(std::size_t index) const {
  const MeshTime now = local(nodes_[index]);
  return changed_[index] || nodes_[index].endpoint->next_deadline() <= now ||
         (config_.upper != nullptr && config_.upper->next_turn(index) <= now);
}

MeshTime Simulation::next_time() const {
  MeshTime next = kNever;
  if (!actions_.empty()) next = actions_.begin()->first;
  for (const auto& network : networks_) next = std::min(next, network->next_event());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].endpoint) continue;
    if (has_turn(i)) return now_;
    MeshTime deadline = nodes_[i].endpoint->next_deadline();
    if (config_.upper != nullptr) deadline = std::min(deadline, config_.upper->next_turn(i));
    if (deadline != kNever) next = std::min(next, deadline - nodes_[i].clock_offset);
  }
  return std::max(next, now_);
}

void Simulation::check_memory() {
  if (now_ - memory_checked_ < kMemoryEvery) return;
  const auto seconds =
      static_cast<std::uint64_t>((now_ - memory_checked_) / std::chrono::seconds(1)) + 1;
  memory_checked_ = now_;
  if (config_.planted == Planted::kLeak) planted_leak_ += config_.memory_max / 10;
  for (SimNode& node : nodes_) {
    if (node.endpoint) {
      const std::size_t above =
          config_.upper != nullptr ? config_.upper->memory_bytes(node.id - 1) : 0;
      ledger_.on_memory(now_, node.id, node.endpoint->memory_bytes() + above + planted_leak_,
                        config_.memory_max);
    }
    if (node.polls > kPollsPerSecondMax * seconds) {
      ledger_.fail(now_, "node " + std::to_string(node.id) +
                             " loops: " + std::to_string(node.polls) + " polls");
    }
    node.polls = 0;
  }
}

bool Simulation::run_until(MeshTime end, const std::function<bool()>& done) {
  while (true) {
    const MeshTime next = next_time();
    if (next > end) break;
    now_ = next;
    while (!actions_.empty() && actions_.begin()->first <= now_) {
      const auto action = std::move(actions_.begin()->second);
      actions_.erase(actions_.begin());
      action();
    }
    deliver();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      SimNode& node = nodes_[i];
      if (!node.endpoint) continue;
      if (!has_turn(i)) continue;
      changed_[i] = false;
      pump(node);
    }
    check_memory();
    if (done()) return true;
  }
  now_ = end;
  return false;
}

}  // namespace warren::mesh::sim
