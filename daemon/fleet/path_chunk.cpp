// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/path_chunk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/replication/layer_wire.hpp"

namespace warren {
namespace {

using replication::Item;
using replication::ItemKind;

constexpr std::uint8_t kPathMark = 't';
constexpr double kCentimetre = 0.01;
constexpr std::int64_t kMillisecond_us = 1000;
constexpr std::int64_t kReach_cm = 1'000'000'000;
constexpr std::uint64_t kTimeMax_ms = std::uint64_t{1} << 50;

// A point as it is on the wire.
struct Whole {
  std::int64_t time_ms = 0;
  std::array<std::int64_t, 3> position_cm{};
};

Whole whole_of(const PathPoint& point) {
  Whole whole;
  whole.time_ms = std::max<std::int64_t>(point.time_us / kMillisecond_us, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    whole.position_cm[i] =
        std::llround(point.position_layer[static_cast<Eigen::Index>(i)] / kCentimetre);
  }
  return whole;
}

PathPoint point_of(const Whole& whole) {
  PathPoint point;
  point.time_us = whole.time_ms * kMillisecond_us;
  for (std::size_t i = 0; i < 3; ++i) {
    point.position_layer[static_cast<Eigen::Index>(i)] =
        static_cast<double>(whole.position_cm[i]) * kCentimetre;
  }
  return point;
}

std::uint64_t folded(std::int64_t number) {
  const auto bits = static_cast<std::uint64_t>(number);
  return number < 0 ? ~(bits << 1) : bits << 1;
}

std::int64_t unfolded(std::uint64_t number) {
  const auto half = static_cast<std::int64_t>(number >> 1);
  return (number & 1) != 0 ? -half - 1 : half;
}

std::optional<Whole> read_next(mesh::PacketReader& from, const Whole& before) {
  const auto step = from.number(kTimeMax_ms);
  if (!step) return std::nullopt;
  Whole next = before;
  next.time_ms += static_cast<std::int64_t>(*step);
  for (std::int64_t& coordinate : next.position_cm) {
    const auto moved = from.number(folded(-2 * kReach_cm));
    if (!moved) return std::nullopt;
    coordinate += unfolded(*moved);
    if (std::abs(coordinate) > kReach_cm) return std::nullopt;
  }
  const bool sane = next.time_ms <= static_cast<std::int64_t>(kTimeMax_ms);
  return sane ? std::optional(next) : std::nullopt;
}

std::vector<std::uint8_t> name_of(const PathChunk& chunk) {
  std::vector<std::uint8_t> name;
  mesh::PacketWriter writer(name);
  writer.byte(kPathMark);
  replication::write(writer, chunk.layer);
  writer.fixed(chunk.number, 4);
  return name;
}

}  // namespace

Item item_of(const PathChunk& chunk) {
  Item item;
  item.kind = ItemKind::kTrajectory;
  item.name = name_of(chunk);
  mesh::PacketWriter writer(item.bytes);
  writer.byte(PathChunk::kKind);
  replication::write(writer, chunk.layer);
  writer.number(chunk.number);
  writer.number(chunk.points.size());
  Whole before;
  for (const PathPoint& point : chunk.points) {
    Whole next = whole_of(point);
    next.time_ms = std::max(next.time_ms, before.time_ms);
    writer.number(static_cast<std::uint64_t>(next.time_ms - before.time_ms));
    for (std::size_t i = 0; i < 3; ++i) {
      writer.number(folded(next.position_cm[i] - before.position_cm[i]));
    }
    before = next;
  }
  return item;
}

std::optional<PathChunk> read_path_chunk(const Item& item) {
  if (item.kind != ItemKind::kTrajectory) return std::nullopt;
  mesh::PacketReader reader(item.bytes);
  if (reader.fixed(1) != PathChunk::kKind) return std::nullopt;
  const auto layer = replication::read_layer_id(reader);
  const auto number = layer ? reader.number(UINT32_MAX) : std::nullopt;
  const auto count = number ? reader.number(PathChunk::kPointsMax) : std::nullopt;
  if (!count || *count == 0) return std::nullopt;
  PathChunk chunk{*layer, static_cast<std::uint32_t>(*number), {}};
  Whole before;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto next = read_next(reader, before);
    if (!next) return std::nullopt;
    chunk.points.push_back(point_of(*next));
    before = *next;
  }
  if (!reader.at_end() || item.name != name_of(chunk)) return std::nullopt;
  return chunk;
}

}  // namespace warren
