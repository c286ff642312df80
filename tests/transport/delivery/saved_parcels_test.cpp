// SPDX-License-Identifier: Apache-2.0
#include "transport/delivery/saved_parcels.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace warren;
using namespace warren::mesh;

namespace {

rc::Gen<std::vector<SavedOutgoing::Parcel>> some_parcels(std::uint32_t end) {
  return rc::gen::map(
      rc::gen::container<std::set<std::uint32_t>>(rc::gen::inRange<std::uint32_t>(0, end)),
      [](const std::set<std::uint32_t>& numbers) {
        std::vector<SavedOutgoing::Parcel> parcels;
        for (const std::uint32_t number : numbers) {
          const auto priority = number % 3 == 0 ? ParcelClass::kControl : ParcelClass::kMessage;
          parcels.push_back({number, priority, std::vector<std::uint8_t>(number % 7, 5)});
        }
        return parcels;
      });
}

SavedPeer some_peer(std::uint32_t member) {
  SavedPeer peer;
  peer.member = {member};
  peer.outgoing.stream = *rc::gen::arbitrary<std::uint64_t>();
  peer.outgoing.next_number = *rc::gen::inRange<std::uint32_t>(100, 0xFFFF'FFFF);
  peer.outgoing.parcels = *some_parcels(100);
  if (*rc::gen::arbitrary<bool>()) peer.incoming.previous_stream = 17;
  if (*rc::gen::arbitrary<bool>()) {
    SavedIncoming::Stream stream{18, *rc::gen::arbitrary<std::uint32_t>(), {}};
    std::uint64_t next = stream.finished_before;
    for (int i = 0; i < 5 && next < 0xFFFF'FF00; ++i) {
      const std::uint64_t first = next + *rc::gen::inRange<std::uint64_t>(i == 0 ? 0 : 1, 20);
      const std::uint64_t end = first + *rc::gen::inRange<std::uint64_t>(1, 20);
      stream.finished.push_back({first, end});
      next = end;
    }
    peer.incoming.stream = stream;
  }
  return peer;
}

std::vector<std::uint8_t> golden_bytes() {
  SavedPeer peer;
  peer.member = {3};
  peer.outgoing = {0x0102030405060708, 300, {{7, ParcelClass::kControl, {9, 8}}}};
  peer.incoming.stream = SavedIncoming::Stream{5, 2, {{4, 6}}};
  return encode({{peer}});
}

}  // namespace

TEST_CASE("what is saved is read back") {
  CHECK(rc::check("what is saved is read back", [] {
    std::vector<SavedPeer> peers;
    const auto count = *rc::gen::inRange<std::uint32_t>(0, 4);
    for (std::uint32_t i = 0; i < count; ++i) peers.push_back(some_peer(10 * i));
    const auto read = read_saved_parcels(encode(peers));
    RC_ASSERT(read.has_value());
    RC_ASSERT(*read == peers);
  }));
}

TEST_CASE("saved parcels keep their format") {
  const auto bytes = golden_bytes();
  const std::vector<std::uint8_t> body(bytes.begin(), bytes.end() - 16);
  CHECK(body == std::vector<std::uint8_t>{
                    'W', 'R', 'M', 'P', 1,                    // version
                    1,   3,   0,   0,   0,                    // one member: 3
                    8,   7,   6,   5,   4, 3, 2, 1, 0xAC, 2,  // stream, next number
                    1,   7,   0,   2,   9, 8,                 // a parcel
                    0,   1,   5,   0,   0, 0, 0, 0, 0,    0,
                    2,   1,   4,   6  // no previous stream; stream 5
                });
}

TEST_CASE("saved parcels with a byte changed, cut off or added are refused") {
  const auto bytes = golden_bytes();
  REQUIRE(read_saved_parcels(bytes));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto changed = bytes;
    changed[i] ^= 0x10;
    CHECK_FALSE(read_saved_parcels(changed));
    CHECK_FALSE(read_saved_parcels(std::span(bytes).first(i)));
    // Without the digest the reader alone must see that it is cut.
    if (i + 16 < bytes.size()) CHECK_FALSE(read_saved_parcels_body(std::span(bytes).first(i)));
  }
  auto longer = bytes;
  longer.push_back(0);
  CHECK_FALSE(read_saved_parcels(longer));
}

TEST_CASE("saved parcels that break what they promise are refused") {
  const auto whole = golden_bytes();
  const std::vector<std::uint8_t> body(whole.begin(), whole.end() - 16);
  REQUIRE(read_saved_parcels_body(body));
  const auto refused = [&](std::size_t place, std::uint8_t value) {
    auto changed = body;
    changed.at(place) = value;
    return !read_saved_parcels_body(changed);
  };
  CHECK(refused(0, 'X'));
  CHECK(refused(4, 2));   // another version
  CHECK(refused(22, 2));  // class
  CHECK(refused(26, 2));  // neither 0 nor 1
  CHECK(refused(36, 5));  // finished_before above what is finished
  CHECK(refused(39, 4));  // an empty range
  CHECK_FALSE(refused(24, 7));
}
