// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/wire_catchup.hpp"

#include <array>
#include <cmath>

#include "core/layer/catch_up.hpp"
#include "tools/warren-bench/wire_sweep.hpp"

namespace warren {
namespace {

constexpr std::array<double, 5> kMissedShares = {0.0, 0.25, 0.5, 0.75, 0.9};

// The bytes of packets until the copy holds all of these keys as the source does.
std::optional<std::uint64_t> raise(const Replica& source, Replica& copy, KeyInterval keys,
                                   std::size_t packet_bytes) {
  std::uint64_t bytes = 0;
  while (!keys.empty()) {
    const KeyInterval around = copy.holdings().interval_around(keys.first);
    const BlockOrdinal end = std::min(around.end, keys.end);
    const Revision held = copy.holdings().at(keys.first);
    const auto packet = source.encode({{keys.first, end}, held, packet_bytes});
    if (packet && copy.apply(copy.id(), packet->bytes) != ApplyResult::kApplied) return {};
    bytes += packet ? packet->bytes.size() : 0;
    keys.first = packet ? packet->claim.keys.end : end;
  }
  return bytes;
}

// A copy that was there for the first ticks.
Replica copy_of_first(const WireTape& tape, std::size_t ticks, const Replica& origin,
                      std::size_t packet_bytes) {
  Replica past(origin.id(), origin.resolution());
  Replica copy(origin.id(), origin.resolution());
  for (std::size_t i = 0; i < ticks; ++i) {
    const Revision from = past.holdings().at(0);
    past.publish(tape.ticks[i]);
    apply_all(copy, sweep(past, from, packet_bytes));
  }
  return copy;
}

std::uint64_t snapshot_bytes(const Replica& origin, Revision since, std::size_t packet_bytes) {
  std::vector<CodedBlock> blocks;
  origin.for_each_changed({}, since, [&](BlockOrdinal block, const LayerBlock& changed) {
    blocks.push_back({block, changed.codes});
    return true;
  });
  Replica snapshot(origin.id(), origin.resolution());
  snapshot.publish(blocks);
  return bytes_of(sweep(snapshot, {}, packet_bytes));
}

std::optional<CatchUp> measure(const WireTape& tape, const Replica& origin, const Replica& relay,
                               double missed_share, std::size_t packet_bytes) {
  const auto all = static_cast<double>(tape.ticks.size());
  const auto ticks = static_cast<std::size_t>(std::lround(all * (1.0 - missed_share)));
  Replica from_origin = copy_of_first(tape, ticks, origin, packet_bytes);
  Replica from_relay = copy_of_first(tape, ticks, origin, packet_bytes);
  CatchUp result;
  result.missed_share = missed_share;
  const Revision held = from_origin.holdings().at(0);
  result.snapshot_bytes = snapshot_bytes(origin, held, packet_bytes);
  result.key_order_bytes = bytes_of(sweep(origin, held, packet_bytes));
  result.relay_key_order_bytes = bytes_of(sweep(relay, held, packet_bytes));
  const auto bytes = catch_up(origin, from_origin, packet_bytes);
  const auto relay_bytes = catch_up(relay, from_relay, packet_bytes);
  if (!bytes || !relay_bytes) return std::nullopt;
  if (!same_blocks(origin, from_origin) || !same_blocks(origin, from_relay)) return std::nullopt;
  result.bytes = *bytes;
  result.relay_bytes = *relay_bytes;
  return result;
}

}  // namespace

std::optional<std::uint64_t> catch_up(const Replica& source, Replica& copy,
                                      std::size_t packet_bytes) {
  std::uint64_t bytes = 0;
  for (const KeyInterval& part : catch_up_parts(source, copy.holdings().lowest({}))) {
    const auto sent = raise(source, copy, part, packet_bytes);
    if (!sent) return std::nullopt;
    bytes += *sent;
  }
  return bytes;
}

std::optional<std::vector<CatchUp>> bench_catch_up(const WireTape& tape, const Replica& origin,
                                                   const WireOptions& options) {
  Replica relay(origin.id(), origin.resolution());
  if (!catch_up(origin, relay, options.packet_bytes)) return std::nullopt;
  std::vector<CatchUp> results;
  for (const double share : kMissedShares) {
    const auto result = measure(tape, origin, relay, share, options.packet_bytes);
    if (!result) return std::nullopt;
    results.push_back(*result);
  }
  return results;
}

}  // namespace warren
