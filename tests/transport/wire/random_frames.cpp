// SPDX-License-Identifier: Apache-2.0
#include "tests/transport/wire/random_frames.hpp"

#include <algorithm>

#include "transport/wire/envelope.hpp"

namespace warren::mesh::test {
namespace {

std::uint32_t any32(Random& random) {
  return static_cast<std::uint32_t>(any_up_to(random, 0xFFFFFFFF));
}

// Mostly few: tests change every bit of them.
std::size_t some_bytes(Random& random, std::size_t max) {
  return std::min<std::size_t>(max, random() % 10 == 0 ? 1400 : random() % 100);
}

HelloFrame hello(Random& random) { return {{any32(random)}, random() % 2 == 0}; }

// Ascending, not touching, below `end`.
std::vector<NumberRange> ranges(Random& random, std::size_t count, std::uint64_t end) {
  std::vector<NumberRange> found;
  std::uint64_t from = any_up_to(random, end / 2);
  while (found.size() < count && from < end) {
    const NumberRange next{from, from + 1 + any_up_to(random, (end - from - 1) / 2)};
    found.push_back(next);
    from = next.end + 1 + any_up_to(random, (end - next.end) / 2);
  }
  return found;
}

AckFrame ack(Random& random) {
  const std::size_t count = 1 + random() % AckFrame::kRangesMax;
  AckFrame frame{ranges(random, count, kPacketNumberEnd), any32(random), Duration(any32(random)),
                 any32(random), any32(random)};
  std::reverse(frame.ranges.begin(), frame.ranges.end());
  return frame;
}

PingFrame ping(Random& random) { return {static_cast<std::uint16_t>(any_up_to(random, 100))}; }

UrgentFrame urgent(Random& random) {
  return {any32(random), random_bytes(random, random() % (UrgentFrame::kBytesMax + 1))};
}

TelemetryFrame telemetry(Random& random) {
  return {static_cast<std::uint16_t>(any_up_to(random, 0xFFFF)), any32(random),
          random_bytes(random, some_bytes(random, TelemetryFrame::kBytesMax))};
}

ParcelFrame parcel(Random& random) {
  ParcelFrame frame;
  frame.parcel = {random(), any32(random)};
  frame.priority = static_cast<ParcelClass>(random() % 2);
  frame.finished_before =
      frame.parcel.number - static_cast<std::uint32_t>(any_up_to(random, frame.parcel.number));
  frame.total = static_cast<std::uint32_t>(any_up_to(random, ParcelFrame::kBytesMax));
  if (random() % 3 > 0) {
    frame.offset = static_cast<std::uint32_t>(any_up_to(random, frame.total));
  }
  const std::size_t size = some_bytes(random, frame.total - frame.offset);
  frame.bytes = random_bytes(random, random() % 3 > 0 ? size : any_up_to(random, size));
  return frame;
}

ParcelStateFrame parcel_state(Random& random) {
  const std::size_t count = random() % (ParcelStateFrame::kRangesMax + 1);
  return {
      {random(), any32(random)}, random() % 2 == 0, ranges(random, count, ParcelFrame::kBytesMax)};
}

MapFrame map(Random& random) {
  return {static_cast<MapClass>(random() % 2), random_bytes(random, some_bytes(random, 1400))};
}

}  // namespace

std::uint64_t any_up_to(Random& random, std::uint64_t max) {
  const std::uint64_t value = random() >> random() % 64;
  return max == ~std::uint64_t{0} ? value : value % (max + 1);
}

std::vector<std::uint8_t> random_bytes(Random& random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

Frame random_inner_frame(Random& random) {
  switch (random() % 7) {
    case 0:
      return hello(random);
    case 1:
      return ack(random);
    case 2:
      return ping(random);
    case 3:
      return urgent(random);
    case 4:
      return telemetry(random);
    case 5:
      return parcel(random);
    default:
      return parcel_state(random);
  }
}

Frame random_frame(Random& random) {
  return random() % 8 == 0 ? Frame(map(random)) : random_inner_frame(random);
}

Beacon random_beacon(Random& random) {
  Beacon beacon{
      {any32(random)}, any32(random), static_cast<std::uint16_t>(any_up_to(random, 0xFFFF)), {}};
  beacon.heard.resize(random() % (Beacon::kHeardMax + 1));
  for (Beacon::Heard& heard : beacon.heard) {
    heard = {any32(random), static_cast<std::uint8_t>(random())};
  }
  return beacon;
}

}  // namespace warren::mesh::test
