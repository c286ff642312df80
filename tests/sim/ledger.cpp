// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/ledger.hpp"

#include <cassert>
#include <cstring>

#include "transport/wire/envelope.hpp"

namespace warren::mesh::sim {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
  return z ^ z >> 31U;
}

std::uint64_t digest(std::span<const std::uint8_t> bytes) {
  std::uint64_t sum = mix(bytes.size() + 1);
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
    sum = mix(sum ^ word) + 0x9E3779B97F4A7C15U;
  }
  return sum;
}

void put(std::vector<std::uint8_t>& to, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) to.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

std::uint64_t get(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << 8 * i;
  return value;
}

}  // namespace

std::vector<std::uint8_t> stamped(const Stamp& stamp, std::size_t bytes) {
  assert(bytes >= kStampBytes);
  std::vector<std::uint8_t> payload;
  payload.reserve(bytes + 8);
  put(payload, stamp.from, 4);
  put(payload, stamp.life, 4);
  put(payload, stamp.kind, 4);
  put(payload, stamp.number, 8);
  std::uint64_t word = digest(payload) ^ bytes;
  while (payload.size() < bytes) put(payload, word = mix(word + 1), 8);
  payload.resize(bytes);
  return payload;
}

std::optional<Stamp> read_stamped(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kStampBytes) return std::nullopt;
  const Stamp stamp{static_cast<std::uint32_t>(get(bytes.subspan(0, 4))),
                    static_cast<std::uint32_t>(get(bytes.subspan(4, 4))),
                    static_cast<std::uint32_t>(get(bytes.subspan(8, 4))),
                    get(bytes.subspan(12, 8))};
  const auto expected = stamped(stamp, bytes.size());
  if (!std::equal(bytes.begin(), bytes.end(), expected.begin())) return std::nullopt;
  return stamp;
}

void Ledger::fail(MeshTime now, const std::string& what) {
  if (failures_.size() == kFailuresMax) return;
  const double seconds = std::chrono::duration<double>(now.time_since_epoch()).count();
  failures_.push_back("at " + std::to_string(seconds) + " s: " + what);
}

void Ledger::on_parcel_sent(MeshTime now, const Parcel& parcel, ParcelKey key) {
  if (!by_key_.emplace(std::tuple(parcel.from, parcel.to, key), parcels_.size()).second) {
    fail(now, "a parcel's key was used twice");
  }
  by_number_.emplace(std::pair(parcel.from, parcel.number), parcels_.size());
  parcels_.push_back(parcel);
  ++outstanding_;
  outstanding_bytes_ += parcel.bytes;
}

void Ledger::on_parcel_arrived(MeshTime now, std::uint32_t at,
                               std::span<const std::uint8_t> bytes) {
  const auto stamp = read_stamped(bytes);
  const auto known = stamp ? by_number_.find({stamp->from, stamp->number}) : by_number_.end();
  if (known == by_number_.end()) return fail(now, "a parcel arrived that nobody sent");
  Parcel& parcel = parcels_[known->second];
  if (parcel.to != at || parcel.bytes != bytes.size()) return fail(now, "a parcel went astray");
  if (parcel.arrived) {
    if (!parcel.excused) fail(now, "parcel " + std::to_string(parcel.number) + " arrived twice");
    return;
  }
  parcel.arrived = now;
  if (parcel.excused) return;
  --outstanding_;
  outstanding_bytes_ -= parcel.bytes;
}

void Ledger::on_parcel_delivered(MeshTime now, std::uint32_t from, std::uint32_t to,
                                 ParcelKey key) {
  const auto known = by_key_.find({from, to, key});
  if (known == by_key_.end()) return fail(now, "a parcel was reported that nobody sent");
  Parcel& parcel = parcels_[known->second];
  if (!parcel.arrived) fail(now, "a parcel was reported before it arrived");
  if (parcel.reported && !parcel.excused) fail(now, "a parcel was reported twice");
  parcel.reported = true;
}

void Ledger::on_telemetry(MeshTime now, std::uint32_t at, std::uint32_t at_life,
                          std::span<const std::uint8_t> bytes) {
  const auto stamp = read_stamped(bytes);
  if (!stamp) return fail(now, "telemetry arrived that nobody set");
  const std::pair value(stamp->life, stamp->number);
  auto [latest, first] =
      telemetry_.emplace(std::tuple(at, at_life, stamp->from, stamp->kind), value);
  if (!first && value <= latest->second) fail(now, "telemetry went back or was repeated");
  latest->second = value;
}

void Ledger::on_urgent(MeshTime now, std::uint32_t at, std::uint32_t at_life,
                       std::span<const std::uint8_t> bytes) {
  const auto stamp = read_stamped(bytes);
  if (!stamp) return fail(now, "something urgent arrived that nobody sent");
  if (++urgent_[{at, at_life, stamp->from, stamp->number}] > 1) {
    fail(now, "something urgent arrived twice");
  }
}

void Ledger::on_map(MeshTime now, std::uint32_t at, std::span<const std::uint8_t> bytes) {
  const auto stamp = read_stamped(bytes);
  if (!stamp) return fail(now, "a map packet arrived that nobody sent");
  ++map_arrived_[{stamp->from, stamp->number}];
  if (++map_arrived_at_[{at, stamp->from, stamp->number}] > 1) {
    fail(now, "a map packet arrived twice");
  }
  ++map_counts_[{at, static_cast<MapClass>(stamp->kind)}];
}

void Ledger::on_map_acknowledged(MeshTime now, std::uint32_t from, std::uint64_t ticket) {
  if (!map_arrived_.contains({from, ticket})) {
    fail(now, "a map packet was acknowledged that did not arrive");
  }
}

void Ledger::on_datagram(MeshTime now, std::optional<BootId> receiver,
                         std::span<const std::uint8_t> bytes) {
  const auto header = read_packet_header(bytes);
  if (!header) return fail(now, "a datagram without a header was sent");
  const std::uint64_t name =
      mix(mix(mix(header->sender.bits) ^ header->number) ^
          (static_cast<std::uint64_t>(header->type) << 32) ^ receiver.value_or(BootId{}).bits);
  const auto [known, first] = datagrams_.emplace(name, digest(bytes));
  if (!first && known->second != digest(bytes)) fail(now, "a nonce was used twice");
}

void Ledger::on_store_lost(std::uint32_t node) {
  for (Parcel& parcel : parcels_) {
    if (parcel.excused || (parcel.from != node && parcel.to != node)) continue;
    if (parcel.to == node && parcel.arrived && parcel.reported) continue;
    parcel.excused = true;
    if (parcel.arrived) continue;
    // One that only its receiver forgot has to arrive as before, but may arrive twice.
    --outstanding_;
    outstanding_bytes_ -= parcel.bytes;
  }
}

void Ledger::on_memory(MeshTime now, std::uint32_t node, std::size_t bytes, std::size_t bound) {
  if (bytes <= bound) return;
  fail(now, "node " + std::to_string(node) + " uses " + std::to_string(bytes) + " bytes");
}

std::size_t Ledger::outstanding() const { return outstanding_; }
std::size_t Ledger::outstanding_bytes() const { return outstanding_bytes_; }

std::size_t Ledger::map_packets_arrived(std::uint32_t at, MapClass priority) const {
  const auto count = map_counts_.find({at, priority});
  return count == map_counts_.end() ? 0 : count->second;
}

}  // namespace warren::mesh::sim
