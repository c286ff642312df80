// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/forged_frames.hpp"

#include <algorithm>

#include "transport/wire/envelope.hpp"

namespace warren::fuzz {

using namespace mesh;
namespace {

constexpr std::size_t kFrameKinds = 8;

std::vector<std::uint8_t> filler(std::size_t bytes) { return std::vector<std::uint8_t>(bytes, 7); }

ParcelKey forged_key(FuzzBytes& in, const Known& known) {
  const std::uint8_t choice = in.byte();
  if (choice % 4 != 0 && !known.parcels.empty())
    return known.parcels[choice % known.parcels.size()];
  return {choice / 4U, static_cast<std::uint32_t>(in.number_to(UINT32_MAX))};
}

// From around the newest number down: mostly what was sent, and what was not yet.
AckFrame forged_ack(FuzzBytes& in, const Known& known) {
  AckFrame ack;
  std::uint64_t end = known.newest + 1 + in.number_to(kPacketNumberEnd - known.newest - 2);
  end -= std::min<std::uint64_t>(in.byte(), end - 1);
  const std::size_t ranges = 1 + in.byte() % AckFrame::kRangesMax;
  while (ack.ranges.size() < ranges && end > 0) {
    const std::uint64_t first = end - 1 - std::min(in.number_to(UINT32_MAX), end - 1);
    ack.ranges.push_back({first, end});
    const std::uint64_t gap = 1 + in.number_to(UINT32_MAX);
    end = first > gap ? first - gap : 0;
  }
  ack.arrived_us = static_cast<std::uint32_t>(in.number(4));
  ack.delay = Duration(static_cast<Duration::rep>(in.number_to(UINT32_MAX)));
  ack.pair_bytes = static_cast<std::uint32_t>(in.number(4));
  ack.pair_us = static_cast<std::uint32_t>(in.number(4));
  return ack;
}

ParcelFrame forged_parcel(FuzzBytes& in, const Known& known) {
  ParcelFrame frame;
  frame.parcel = forged_key(in, known);
  frame.priority = in.flag() ? ParcelClass::kControl : ParcelClass::kMessage;
  const std::uint64_t age = in.number_to(frame.parcel.number);
  frame.finished_before = frame.parcel.number - static_cast<std::uint32_t>(age);
  frame.total = static_cast<std::uint32_t>(in.number_to(ParcelFrame::kBytesMax));
  frame.offset = static_cast<std::uint32_t>(in.number_to(frame.total));
  const std::size_t most = std::min<std::size_t>(frame.total - frame.offset, 1200);
  frame.bytes = filler(in.number_to(most));
  return frame;
}

ParcelStateFrame forged_state(FuzzBytes& in, const Known& known) {
  ParcelStateFrame state{forged_key(in, known), in.byte() % 4 == 0, {}};
  const std::size_t ranges = in.byte() % (ParcelStateFrame::kRangesMax + 1);
  std::uint64_t first = in.number_to(ParcelFrame::kBytesMax);
  while (state.have.size() < ranges && first < ParcelFrame::kBytesMax) {
    const std::uint64_t end = first + 1 + in.number_to(ParcelFrame::kBytesMax - first - 1);
    state.have.push_back({first, end});
    first = end + 1 + in.number_to(ParcelFrame::kBytesMax);
  }
  return state;
}

}  // namespace

Frame forged_frame(FuzzBytes& in, const Known& known) {
  switch (in.byte() % kFrameKinds) {
    case 0:
      return HelloFrame{MemberId{static_cast<std::uint32_t>(in.number_to(UINT32_MAX))}, in.flag()};
    case 1:
      return PingFrame{static_cast<std::uint16_t>(in.number_to(1300))};
    case 2:
      return UrgentFrame{static_cast<std::uint32_t>(in.number_to(UINT32_MAX)),
                         filler(in.byte() % (UrgentFrame::kBytesMax + 1))};
    case 3:
      return TelemetryFrame{static_cast<std::uint16_t>(in.number_to(UINT16_MAX)),
                            static_cast<std::uint32_t>(in.number_to(UINT32_MAX)),
                            filler(in.number_to(TelemetryFrame::kBytesMax))};
    case 4:
      return forged_parcel(in, known);
    case 5:
      return forged_state(in, known);
    case 6:
      return MapFrame{in.flag() ? MapClass::kFresh : MapClass::kBacklog,
                      filler(in.number_to(1300))};
    default:
      return forged_ack(in, known);
  }
}

Beacon forged_beacon(FuzzBytes& in, const Known& known) {
  Beacon beacon;
  beacon.member = {static_cast<std::uint32_t>(in.number_to(UINT32_MAX))};
  beacon.uptime_s = static_cast<std::uint32_t>(in.number_to(UINT32_MAX));
  beacon.period_ms = static_cast<std::uint16_t>(in.number(2));
  const std::size_t heard = in.byte() % (Beacon::kHeardMax + 1);
  for (std::size_t i = 0; i < heard; ++i) {
    const std::uint8_t choice = in.byte();
    const std::uint32_t boot = choice < 0x80 ? known.boot_halves[choice % known.boot_halves.size()]
                                             : std::uint32_t{choice};
    beacon.heard.push_back({boot, in.byte()});
  }
  return beacon;
}

}  // namespace warren::fuzz
