// SPDX-License-Identifier: Apache-2.0
// What the nodes are given to send, and what arrives.
#include <utility>

#include "tests/sim/simulation.hpp"
#include "transport/visitor.hpp"

namespace warren::mesh::sim {
namespace {

std::uint64_t name_of(std::uint32_t from, std::uint64_t number, bool urgent) {
  return std::uint64_t{from} << 40U | (urgent ? std::uint64_t{1} << 39U : 0) | number;
}

}  // namespace

bool Simulation::send_parcel(std::size_t from, std::size_t to, ParcelClass priority,
                             std::size_t bytes) {
  SimNode& node = nodes_[from];
  if (!node.endpoint) return false;
  const std::uint64_t number = node.next_number++;
  const auto payload = stamped({node.id, 0, 0, number}, bytes);
  const auto key = node.endpoint->send_parcel(local(node), {nodes_[to].id}, priority, payload);
  changed_[from] = true;
  if (!key) return false;
  Ledger::Parcel parcel;
  parcel.from = node.id;
  parcel.to = nodes_[to].id;
  parcel.number = number;
  parcel.bytes = payload.size();
  parcel.sent = now_;
  ledger_.on_parcel_sent(now_, parcel, *key);
  node.store = node.endpoint->save();
  return true;
}

void Simulation::send_urgent(std::size_t from, std::optional<std::size_t> to) {
  SimNode& node = nodes_[from];
  if (!node.endpoint) return;
  const std::uint64_t number = node.next_number++;
  sent_at_[name_of(node.id, number, true)] = now_;
  std::optional<MemberId> member;
  if (to) member = MemberId{nodes_[*to].id};
  (void)node.endpoint->send_urgent(local(node), member, stamped({node.id, 0, 0, number}, 40));
  changed_[from] = true;
}

void Simulation::set_telemetry(std::size_t from, std::uint16_t key, std::size_t bytes) {
  SimNode& node = nodes_[from];
  if (!node.endpoint) return;
  const std::uint64_t number = node.telemetry_number++;
  sent_at_[name_of(node.id, number, false)] = now_;
  (void)node.endpoint->set_telemetry(local(node), key,
                                     stamped({node.id, node.life, key, number}, bytes));
  changed_[from] = true;
}

void Simulation::add_map(std::size_t from, std::size_t to, MapClass priority, std::uint64_t bytes) {
  SimNode& node = nodes_[from];
  node.source->add({nodes_[to].id}, priority, bytes);
  if (node.endpoint) node.endpoint->wake(local(node), {nodes_[to].id});
  changed_[from] = true;
}

void Simulation::add_group(std::size_t from, std::uint64_t bytes) {
  SimNode& node = nodes_[from];
  node.source->add_group(bytes);
  for (std::size_t k = 0; node.endpoint && k < networks_.size(); ++k) {
    node.endpoint->wake_group(static_cast<InterfaceIndex>(k));
  }
  changed_[from] = true;
}

void Simulation::inject(std::size_t to, std::size_t interface, const MeshAddress& from,
                        std::vector<std::uint8_t> bytes) {
  SimNode& node = nodes_[to];
  if (!node.endpoint) return;
  node.endpoint->on_datagram(local(node), {static_cast<InterfaceIndex>(interface), false, from},
                             bytes);
  changed_[to] = true;
}

void Simulation::on_parcel(SimNode& node, const ParcelArrived& parcel) {
  if (config_.planted == Planted::kFragmentLost && parcel.bytes.size() % 2 == 1) return;
  ledger_.on_parcel_arrived(now_, node.id, parcel.bytes);
  if (config_.planted == Planted::kParcelTwice) {
    ledger_.on_parcel_arrived(now_, node.id, parcel.bytes);
  }
  node.endpoint->finish_parcel(local(node), parcel.from, parcel.key);
  node.store = node.endpoint->save();
}

void Simulation::on_event(SimNode& node, MeshEvent&& event) {
  if (config_.upper != nullptr) {
    return config_.upper->on_event(local(node), index_of(node), std::move(event));
  }
  const auto latency = [&](const std::vector<std::uint8_t>& bytes, bool urgent) {
    const auto stamp = read_stamped(bytes);
    return stamp ? now_ - sent_at_[name_of(stamp->from, stamp->number, urgent)] : Duration{};
  };
  const auto arrived = [&] {
    if (!node.first_arrival) node.first_arrival = now_;
  };
  std::visit(
      Visitor{[&](const UrgentArrived& urgent) {
                arrived();
                ledger_.on_urgent(now_, node.id, node.life, urgent.bytes);
                node.urgent_latency.push_back(latency(urgent.bytes, true));
              },
              [&](const TelemetryArrived& telemetry) {
                arrived();
                ledger_.on_telemetry(now_, node.id, node.life, telemetry.bytes);
                node.telemetry_latency.push_back(latency(telemetry.bytes, false));
                if (config_.planted != Planted::kTelemetryStale) return;
                if (!planted_telemetry_.empty()) {
                  ledger_.on_telemetry(now_, node.id, node.life, planted_telemetry_);
                }
                planted_telemetry_ = telemetry.bytes;
              },
              [&](const ParcelArrived& parcel) {
                arrived();
                on_parcel(node, parcel);
              },
              [&](const ParcelDelivered& parcel) {
                ledger_.on_parcel_delivered(now_, node.id, parcel.to.number, parcel.key);
                node.store = node.endpoint->save();
              },
              [&](const MapArrived& map) {
                arrived();
                ledger_.on_map(now_, node.id, map.bytes);
              },
              [&](const MemberUp& up) { ++node.members_up[up.member.number]; }, [](const auto&) {}},
      event);
}

}  // namespace warren::mesh::sim
