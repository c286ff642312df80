// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/layer_wire.hpp"

#include <limits>

namespace warren::replication {
namespace {

constexpr std::uint64_t kRevisionMax = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void write(mesh::PacketWriter& to, const LayerId& id) {
  to.fixed(id.origin, 4);
  to.fixed(id.number, 4);
  to.fixed(id.incarnation, 8);
}

std::optional<LayerId> read_layer_id(mesh::PacketReader& from) {
  const auto origin = from.fixed(4);
  const auto number = from.fixed(4);
  const auto incarnation = from.fixed(8);
  if (!origin || !number || !incarnation) return std::nullopt;
  return LayerId{static_cast<std::uint32_t>(*origin), static_cast<std::uint32_t>(*number),
                 *incarnation};
}

// The number of intervals; the first one's revision; of each other how many keys after the one
// before it begins, and its revision.
void write(mesh::PacketWriter& to, const Holdings& holdings) {
  const auto intervals = holdings.intervals();
  to.number(intervals.size());
  to.number(intervals[0].held.number);
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    to.number(intervals[i].first - intervals[i - 1].first);
    to.number(intervals[i].held.number);
  }
}

std::optional<Holdings> read_holdings(mesh::PacketReader& from) {
  const auto count = from.number(Holdings::kIntervalsMax);
  if (!count || *count == 0) return std::nullopt;
  std::vector<Holdings::Interval> intervals;
  BlockOrdinal first = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto step = i == 0 ? std::optional<std::uint64_t>(0) : from.number(kOrdinalEnd);
    const auto held = step ? from.number(kRevisionMax) : std::nullopt;
    if (!held) return std::nullopt;
    first += *step;
    intervals.push_back({first, Revision{static_cast<std::uint32_t>(*held)}});
  }
  return Holdings::from_intervals(intervals);
}

// The number of intervals, 0 for everything; of each the keys left out before it, and its length.
void write(mesh::PacketWriter& to, const KeySet& keys) {
  if (keys.is_everything()) return to.number(0);
  to.number(keys.intervals.size());
  BlockOrdinal end = 0;
  for (const KeyInterval& interval : keys.intervals) {
    to.number(interval.first - end);
    to.number(interval.end - interval.first);
    end = interval.end;
  }
}

std::optional<KeySet> read_key_set(mesh::PacketReader& from) {
  const auto count = from.number(KeySet::kIntervalsMax);
  if (!count) return std::nullopt;
  KeySet keys;
  if (*count == 0) return keys;
  keys.intervals.clear();
  BlockOrdinal end = 0;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto skipped = from.number(kOrdinalEnd);
    const auto length = skipped ? from.number(kOrdinalEnd) : std::nullopt;
    if (!length || *length == 0 || (i > 0 && *skipped == 0)) return std::nullopt;
    const BlockOrdinal first = end + *skipped;
    end = first + *length;
    if (end > kOrdinalEnd) return std::nullopt;
    keys.intervals.push_back({first, end});
  }
  return keys.is_everything() ? std::nullopt : std::optional(keys);
}

}  // namespace warren::replication
