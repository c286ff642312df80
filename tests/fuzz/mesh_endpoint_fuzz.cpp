// SPDX-License-Identifier: Apache-2.0
// A whole endpoint: the input says what two of them, who know each other, are given to do, what
// becomes of their packets, and what one who has all keys tells them in between. mesh_pair.hpp
// says what holds all the time.
#include <algorithm>
#include <array>

#include "tests/fuzz/forged_frames.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/mesh_pair.hpp"

namespace warren::fuzz {

using namespace mesh;
namespace {

constexpr int kStepsMax = 500;
constexpr std::size_t kContentMax = 1400;

// From 0.1 ms to 3 s.
void pass(FuzzBytes& in, MeshPair& pair) {
  const std::uint8_t choice = in.byte();
  pair.pass(Duration(100) * (1U << (choice & 15U)), static_cast<MeshPair::Air>((choice >> 4U) % 3));
}

// Up to two hours.
void jump(FuzzBytes& in, MeshPair& pair) { pair.jump(std::chrono::seconds(30) * in.byte()); }

MeshPair::Flight* flight(FuzzBytes& in, MeshPair& pair, std::size_t* index = nullptr) {
  if (pair.air().empty()) return nullptr;
  const std::size_t chosen = in.byte() % pair.air().size();
  if (index != nullptr) *index = chosen;
  return &pair.air()[chosen];
}

enum class Fate : std::uint8_t { kArrives, kArrivesTwice, kIsLost };

void decide_flight(FuzzBytes& in, MeshPair& pair, Fate fate) {
  std::size_t index = 0;
  const MeshPair::Flight* chosen = flight(in, pair, &index);
  if (chosen == nullptr) return;
  const MeshPair::Flight copy = *chosen;
  if (fate != Fate::kArrivesTwice) {
    pair.air().erase(pair.air().begin() + static_cast<std::ptrdiff_t>(index));
  }
  if (fate != Fate::kIsLost) pair.deliver(copy);
}

// One bit flips on the way.
void corrupt(FuzzBytes& in, MeshPair& pair) {
  MeshPair::Flight* chosen = flight(in, pair);
  if (chosen == nullptr) return;
  auto& bytes = chosen->datagram.bytes;
  const std::uint64_t bit = in.number(2) % (8 * bytes.size());
  bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
}

Key key_for(MeshPair& pair, const PacketHeader& header, std::size_t to) {
  return header.type == PacketType::kPair ? pair.keys().pair_key(header.sender, pair.side(to).boot)
                                          : pair.keys().group_key(header.sender);
}

// What was sent honestly arrives with another content.
void tamper(FuzzBytes& in, MeshPair& pair) {
  const MeshPair::Flight* chosen = flight(in, pair);
  if (chosen == nullptr) return;
  const std::size_t to = 1 - chosen->from;
  const auto header = read_packet_header(chosen->datagram.bytes);
  if (!header) return;
  const Key key = key_for(pair, *header, to);
  auto content = open(key, chosen->datagram.bytes);
  if (!content) return;
  const std::size_t changes = in.byte() % 8;
  for (std::size_t i = 0; i < changes && !content->empty(); ++i) {
    const std::size_t at = in.byte() % content->size();
    (*content)[at] = in.byte();
  }
  if (in.byte() % 4 == 0) content->resize(in.byte() % (content->size() + 1));
  pair.inject(to, chosen->source, seal(key, *header, *content));
}

// Mostly the next number, or one of the next; sometimes one far ahead, or one that was.
std::uint64_t number_after(FuzzBytes& in, std::uint64_t newest) {
  const std::uint8_t choice = in.byte();
  std::uint64_t number = newest + 1 + (choice & 7U);
  if (choice >= 0xF0) number += in.number(3);
  if (choice >= 0xE0 && choice < 0xF0) number = newest - std::min<std::uint64_t>(newest, in.byte());
  return std::min(number, kPacketNumberEnd - 1);
}

struct Forger {
  std::size_t to = 0;
  BootId boot;
  MeshPath source;
};

// The other one, or a boot that nobody had.
Forger forger(FuzzBytes& in, MeshPair& pair) {
  const std::uint8_t choice = in.byte();
  Forger forger;
  forger.to = choice & 1U;
  const std::size_t interface = choice >> 1U & 1U;
  forger.boot = choice < 0xC0 ? pair.side(1 - forger.to).boot : pair.fresh_boot();
  forger.source = pair.path_of(1 - forger.to, interface);
  if ((choice & 0x1CU) == 0x1CU) forger.source.address.ip[13] = in.byte();
  return forger;
}

void send_forged(FuzzBytes& in, MeshPair& pair, const Forger& forger, PacketType type,
                 std::span<const std::uint8_t> content) {
  auto& newest = pair.newest(forger.boot, type);
  const PacketHeader header{type, forger.boot, number_after(in, newest)};
  newest = std::max(newest, header.number);
  pair.inject(forger.to, forger.source, seal(key_for(pair, header, forger.to), header, content));
}

void forge_bytes(FuzzBytes& in, MeshPair& pair) {
  const Forger who = forger(in, pair);
  const auto type = static_cast<PacketType>(in.byte() % 3);
  send_forged(in, pair, who, type, in.take(in.byte()));
}

void forge_frames(FuzzBytes& in, MeshPair& pair) {
  const Forger who = forger(in, pair);
  const std::array halves{static_cast<std::uint32_t>(pair.side(who.to).boot.bits)};
  const Known known{pair.newest(pair.side(who.to).boot, PacketType::kPair), pair.parcels(), halves};
  const std::size_t frames = 1 + in.byte() % 5;
  std::vector<std::uint8_t> content;
  for (std::size_t i = 0; i < frames && content.size() < kContentMax; ++i) {
    append(content, forged_frame(in, known));
  }
  send_forged(in, pair, who, in.byte() < 0xF0 ? PacketType::kPair : PacketType::kGroup, content);
}

void forge_beacon(FuzzBytes& in, MeshPair& pair) {
  const Forger who = forger(in, pair);
  const std::array halves{static_cast<std::uint32_t>(pair.side(who.to).boot.bits)};
  send_forged(in, pair, who, PacketType::kBeacon, encode(forged_beacon(in, {0, {}, halves})));
}

void send_something(FuzzBytes& in, MeshPair& pair) {
  const std::uint8_t choice = in.byte();
  const std::size_t from = choice & 1U;
  switch (choice >> 1U & 3U) {
    case 0: {
      // As many strangers as there is room for.
      const bool stranger = choice >= 0xF0;
      const MemberId to = stranger ? MemberId{3U + in.byte() % 5U} : pair.side(1 - from).id;
      const auto priority = (choice & 8U) != 0 ? ParcelClass::kControl : ParcelClass::kMessage;
      return pair.send_parcel(from, to, priority, in.number_to(1'000'000));
    }
    case 1:
      return pair.set_telemetry(from, in.byte(), in.number_to(TelemetryFrame::kBytesMax));
    case 2:
      return pair.send_urgent(from, (choice & 8U) != 0, in.byte() % 70);
    default:
      return pair.add_map(from, in.byte() % 64, in.byte() % 16, 1 + in.number_to(1400));
  }
}

void step(FuzzBytes& in, MeshPair& pair) {
  switch (in.byte() % 14) {
    case 0:
    case 1:
      return pass(in, pair);
    case 2:
      return jump(in, pair);
    case 3:
      return decide_flight(in, pair, Fate::kArrives);
    case 4:
      return decide_flight(in, pair, Fate::kArrivesTwice);
    case 5:
      return decide_flight(in, pair, Fate::kIsLost);
    case 6:
      return corrupt(in, pair);
    case 7:
      return tamper(in, pair);
    case 8:
      return forge_bytes(in, pair);
    case 9:
      return forge_frames(in, pair);
    case 10:
      return forge_beacon(in, pair);
    case 11:
      return send_something(in, pair);
    case 12:
      return pair.store_parcel(in.byte() & 1U);
    default:
      const std::uint8_t choice = in.byte();
      return (choice & 2U) != 0 ? pair.restart(choice & 1U) : pair.move(choice & 1U);
  }
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  warren::fuzz::FuzzBytes in({data, size});
  warren::fuzz::MeshPair pair;
  for (int steps = 0; steps < warren::fuzz::kStepsMax && !in.done(); ++steps) {
    warren::fuzz::step(in, pair);
    pair.settle();
    if (steps % 32 == 0) pair.check_memory();
  }
  pair.check_memory();
  pair.heal();
  return 0;
}
