// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mesh_pair.hpp"

#include <algorithm>
#include <cassert>

#include <sanitizer/allocator_interface.h>

#include "transport/visitor.hpp"

namespace warren::fuzz {

using namespace mesh;
namespace {

constexpr std::size_t kParcelsBytesMax = 4'000'000;
// Of both: parcels, and the records of sent packets of all sessions.
constexpr std::size_t kHeapMax = 48'000'000;
constexpr std::size_t kParcelsNamedMax = 64;
constexpr std::size_t kPayloadBytesMin = 8;
// Of one endpoint at one instant: all that it can have to send at once.
constexpr std::size_t kPacketsAtOnceMax = 8192;
constexpr Duration kFlightTime = std::chrono::milliseconds(5);
// What an input may take, so that it is fast.
constexpr Duration kPassMost = std::chrono::minutes(3);
constexpr Duration kHealMost = std::chrono::minutes(2);
// Times at which a driver is woken and nothing comes of it.
constexpr std::int64_t kIdleWakeups = 100;
constexpr std::int64_t kIdleWakeupsPerS = 200;

}  // namespace

std::optional<MapSource::Packet> MapSupply::next_for(MemberId, MapClass wanted, std::size_t limit) {
  assert(limit >= kBytesMin);
  auto& of_class = left[static_cast<std::size_t>(wanted)];
  if (of_class == 0) return std::nullopt;
  --of_class;
  return Packet{next_ticket_++, wanted, std::vector<std::uint8_t>(std::min(bytes, limit))};
}

std::optional<MapSource::Packet> MapSupply::next_for_group(InterfaceIndex, std::size_t limit) {
  assert(limit >= kBytesMin);
  if (group_left == 0) return std::nullopt;
  --group_left;
  return Packet{next_ticket_++, MapClass::kFresh,
                std::vector<std::uint8_t>(std::min(bytes, limit))};
}

void MapSupply::on_acknowledged(MemberId, std::uint64_t ticket) { assert(ticket < next_ticket_); }
void MapSupply::on_lost(MemberId, std::uint64_t ticket) { assert(ticket < next_ticket_); }

MeshPair::MeshPair() : keys_(std::make_shared<PresharedKeys>(Key{1, 2, 3})) {
  heap_before_ = __sanitizer_get_current_allocated_bytes();
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    sides_[i].id = {static_cast<std::uint32_t>(i + 1)};
    sides_[i].address = static_cast<std::uint8_t>(i);
    start(i);
  }
  pass(std::chrono::seconds(1), Air::kCarries);
  for (const PairSide& side : sides_) assert(!side.endpoint->members().empty());
  passed_ = {};
}

void MeshPair::start(std::size_t index) {
  PairSide& side = sides_[index];
  side.boot = fresh_boot();
  EndpointConfig config;
  config.self = side.id;
  config.boot = side.boot;
  config.random_seed = index;
  config.members_max = kMembersMax;
  config.parcels_bytes_max = kParcelsBytesMax;
  config.interfaces.resize(kInterfaces);
  config.interfaces[1].mtu_bytes = 600;
  config.interfaces[1].group_broadcast = true;
  config.interfaces[1].ceiling_bit_s = 1e6;
  side.endpoint = std::make_unique<Endpoint>(config, keys_, side.map);
  if (!side.store.empty()) {
    const bool taken = side.endpoint->restore(side.store);
    assert(taken);
    side.store = side.endpoint->save();
  }
}

void MeshPair::restart(std::size_t index) {
  PairSide& side = sides_[index];
  side.endpoint.reset();
  side.waiting.clear();
  side.urgent.clear();
  side.telemetry.clear();
  start(index);
}

MeshPath MeshPair::path_of(std::size_t side, std::size_t interface) const {
  MeshPath path{static_cast<InterfaceIndex>(interface), false, {}};
  path.address.ip[14] = path.interface;
  path.address.ip[15] = sides_[side].address;
  path.address.port = 7718;
  return path;
}

void MeshPair::pump(std::size_t index) {
  PairSide& side = sides_[index];
  std::size_t packets = 0;
  while (auto datagram = side.endpoint->poll_transmit(now_)) {
    ++packets;
    assert(packets <= kPacketsAtOnceMax);
    const auto header = read_packet_header(datagram->bytes);
    assert(header && header->sender == side.boot);
    auto& highest = newest(header->sender, header->type);
    highest = std::max(highest, header->number);
    if (air_.size() == kFlightsMax) air_.pop_front();
    const MeshPath source = path_of(index, datagram->to.interface);
    air_.push_back({index, source, *std::move(datagram), now_ + kFlightTime});
  }
  sent_ += packets;
  assert(side.endpoint->next_deadline() > now_);
  while (auto event = side.endpoint->poll_event()) on_event(side, *std::move(event));
}

void MeshPair::settle() {
  for (std::size_t i = 0; i < sides_.size(); ++i) pump(i);
}

void MeshPair::pass(Duration time, Air air) {
  time = std::min(time, kPassMost - passed_);
  passed_ += time;
  const MeshTime end = now_ + time;
  std::int64_t idle = 0;
  while (true) {
    const std::uint64_t sent = sent_;
    settle();
    if (sent == sent_) ++idle;
    if (air == Air::kLoses) air_.clear();
    MeshTime next =
        std::min(sides_[0].endpoint->next_deadline(), sides_[1].endpoint->next_deadline());
    if (air == Air::kCarries && !air_.empty()) {
      next = std::min(next, std::max(air_.front().arrives, now_));
    }
    if (next > end) break;
    now_ = next;
    while (air == Air::kCarries && !air_.empty() && air_.front().arrives <= now_) {
      const Flight flight = std::move(air_.front());
      air_.pop_front();
      deliver(flight);
      --idle;
    }
  }
  assert(idle <= kIdleWakeups + kIdleWakeupsPerS * (time / std::chrono::seconds(1) + 1));
  now_ = end;
  settle();
}

void MeshPair::jump(Duration time) {
  now_ += time;
  settle();
}

void MeshPair::deliver(const Flight& flight) {
  const std::size_t to = 1 - flight.from;
  const MeshPath& path = flight.datagram.to;
  if (!path.group && path.address != path_of(to, path.interface).address) return;
  MeshPath from = flight.source;
  from.group = path.group;
  sides_[to].endpoint->on_datagram(now_, from, flight.datagram.bytes);
}

void MeshPair::inject(std::size_t to, const MeshPath& from, std::span<const std::uint8_t> bytes) {
  honest_ = false;
  sides_[to].endpoint->on_datagram(now_, from, bytes);
}

std::vector<std::uint8_t> MeshPair::payload(std::size_t bytes) {
  std::vector<std::uint8_t> payload(std::max(bytes, kPayloadBytesMin), 1);
  const std::uint64_t number = ++payloads_;
  for (std::size_t i = 0; i < kPayloadBytesMin; ++i) {
    payload[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return payload;
}

std::optional<std::uint64_t> MeshPair::number_of(std::span<const std::uint8_t> payload) const {
  if (payload.size() < kPayloadBytesMin) return std::nullopt;
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < kPayloadBytesMin; ++i) {
    number |= std::uint64_t{payload[i]} << (8 * i);
  }
  if (number == 0 || number > payloads_) return std::nullopt;
  return number;
}

void MeshPair::send_parcel(std::size_t from, MemberId to, ParcelClass priority, std::size_t bytes) {
  PairSide& side = sides_[from];
  const auto content = payload(bytes);
  const auto key = side.endpoint->send_parcel(now_, to, priority, content);
  if (!key) return;
  side.store = side.endpoint->save();
  if (parcels_.size() < kParcelsNamedMax) parcels_.push_back(*key);
  if (to == sides_[1 - from].id) promised_.emplace(1 - from, payloads_);
}

void MeshPair::send_urgent(std::size_t from, bool to_all, std::size_t bytes) {
  const auto to = to_all ? std::nullopt : std::optional(sides_[1 - from].id);
  (void)sides_[from].endpoint->send_urgent(now_, to, payload(bytes));
}

void MeshPair::set_telemetry(std::size_t from, std::uint16_t key, std::size_t bytes) {
  (void)sides_[from].endpoint->set_telemetry(now_, key, payload(bytes));
}

void MeshPair::add_map(std::size_t from, std::size_t packets, std::size_t group,
                       std::size_t bytes) {
  PairSide& side = sides_[from];
  side.map.left[packets % 2] += packets / 2;
  side.map.group_left += group;
  side.map.bytes = bytes;
  side.endpoint->wake(now_, sides_[1 - from].id);
  side.endpoint->wake_group(1);
}

void MeshPair::store_parcel(std::size_t index) {
  PairSide& side = sides_[index];
  if (side.waiting.empty()) return;
  const auto [number, key] = side.waiting.front();
  side.waiting.pop_front();
  side.endpoint->finish_parcel(now_, sides_[1 - index].id, key);
  side.store = side.endpoint->save();
  const bool first = side.stored.insert(number).second;
  assert(first || !honest_);
}

void MeshPair::on_event(PairSide& side, MeshEvent&& event) {
  const auto take = [&](std::span<const std::uint8_t> payload) {
    const auto number = number_of(payload);
    assert(number || !honest_);
    return number.value_or(0);
  };
  std::visit(Visitor{[&](const UrgentArrived& urgent) {
                       const bool first = side.urgent.insert(take(urgent.bytes)).second;
                       assert(first || !honest_);
                     },
                     [&](const TelemetryArrived& value) {
                       const std::uint64_t number = take(value.bytes);
                       assert(number > side.telemetry[value.key] || !honest_);
                       side.telemetry[value.key] = number;
                     },
                     [&](const ParcelArrived& parcel) {
                       if (honest_ || parcel.from == sides_[&side == &sides_[0] ? 1 : 0].id) {
                         side.waiting.emplace_back(take(parcel.bytes), parcel.key);
                       }
                     },
                     [&](const auto&) {}},
             event);
}

void MeshPair::check_memory() const {
  for (const PairSide& side : sides_) {
    assert(side.endpoint->memory_bytes() <= kHeapMax);
    assert(side.endpoint->members().size() <= kMembersMax);
  }
  // One input's own: what it has sent and stored is small.
  assert(__sanitizer_get_current_allocated_bytes() <= heap_before_ + kHeapMax);
}

bool MeshPair::quiet() const {
  return std::all_of(promised_.begin(), promised_.end(), [&](const auto& parcel) {
    return sides_[parcel.first].stored.contains(parcel.second);
  });
}

void MeshPair::heal() {
  const Duration step = std::chrono::milliseconds(500);
  for (Duration healed{}; honest_ && healed < kHealMost && !quiet(); healed += step) {
    passed_ = {};
    pass(step, Air::kCarries);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      while (!sides_[i].waiting.empty()) store_parcel(i);
    }
  }
  assert(!honest_ || quiet());
}

}  // namespace warren::fuzz
