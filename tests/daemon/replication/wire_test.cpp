// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "daemon/replication/announcement.hpp"
#include "daemon/replication/map_message.hpp"

namespace warren::replication {
namespace {

Holdings holdings_of(const std::vector<std::pair<std::uint16_t, std::uint8_t>>& pieces) {
  Holdings holdings;
  for (const auto& [first, revision] : pieces) {
    const BlockOrdinal from = BlockOrdinal{first} << 20;
    (void)holdings.raise({{from, from + 1000}, Revision{}, Revision{revision + 1U}});
  }
  return holdings;
}

TEST_CASE("an announcement is read as it was written") {
  CHECK(rc::check([](const std::vector<std::pair<std::uint16_t, std::uint8_t>>& pieces,
                     std::uint64_t incarnation, std::uint32_t provider, bool has_provider) {
    Announcement announcement{
        {7, 2, incarnation}, kDefaultResolution, 3, {}, holdings_of(pieces), {}};
    if (has_provider) announcement.provider = MemberId{provider};
    if (announcement.holdings.intervals().size() == 1) announcement.digest = incarnation;
    const auto read = read_announcement(encode(announcement));
    RC_ASSERT(read.has_value());
    RC_ASSERT(*read == announcement);
  }));
}

TEST_CASE("an announcement has these bytes") {
  const Announcement announcement{{7, 2, 5},   kDefaultResolution,      1,
                                  MemberId{6}, Holdings(Revision{300}), 0x0807060504030201};
  const std::vector<std::uint8_t> golden{0x11, 7,    0,    0, 0, 2, 0,    0,    0,    5, 0,
                                         0,    0,    0,    0, 0, 0, 0xA0, 0x8D, 0x06, 1, 7,
                                         1,    0xAC, 0x02, 1, 2, 3, 4,    5,    6,    7, 8};
  CHECK(encode(announcement) == golden);
}

TEST_CASE("an announcement that is cut short, or of another version, is refused") {
  const Announcement announcement{
      {7, 2, 5}, kDefaultResolution, 1, MemberId{6}, holdings_of({{3, 4}, {9, 9}}), {}};
  auto bytes = encode(announcement);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_FALSE(read_announcement(std::span(bytes).first(length)));
  }
  bytes[0] = 0x12;
  CHECK_FALSE(read_announcement(bytes));
}

TEST_CASE("only who holds the whole at one revision may tell a digest") {
  Announcement announcement{{7, 2, 5}, kDefaultResolution, 1, {}, holdings_of({{3, 4}}), 9};
  CHECK_FALSE(read_announcement(encode(announcement)));
}

TEST_CASE("wishes are read as they were written") {
  CHECK(rc::check([](const std::vector<std::pair<std::uint16_t, std::uint8_t>>& pieces,
                     std::uint32_t number, bool lost, std::uint8_t slot) {
    Wish wish{slot, number, true, lost, holdings_of(pieces), KeySet{}};
    if (lost) wish.keys.intervals = {{5, 9}, {slot + 10U, slot + 11U}};
    const Wish none{static_cast<Slot>(slot / 2), number + 1ULL, false, false, Holdings(), KeySet{}};
    std::vector<std::uint8_t> bytes{WishMessage::kKind};
    append(bytes, wish);
    append(bytes, none);
    const auto read = read_map_message(bytes);
    RC_ASSERT(read.has_value());
    RC_ASSERT((std::get<WishMessage>(*read).wishes == std::vector<Wish>{wish, none}));
    for (std::size_t length = 2; length < bytes.size(); ++length) {
      const auto cut = read_map_message(std::span(bytes).first(length));
      const bool shorter = !cut || std::get<WishMessage>(*cut).wishes.size() < 2;
      RC_ASSERT(shorter);
    }
  }));
}

TEST_CASE("digests are asked for and answered in bytes that read back") {
  const auto question = read_map_message(encode(DigestQuestion{3, Revision{400}, 1000}));
  REQUIRE(question);
  CHECK(std::get<DigestQuestion>(*question).first == 1000);
  CHECK(std::get<DigestQuestion>(*question).revision.number == 400);
  DigestAnswer answer{3, Revision{400}, 1000, 2000, {{1000, 5}, {1001, 6}, {1999, 7}}};
  const auto read = read_map_message(encode(answer));
  REQUIRE(read);
  const auto& regions = std::get<DigestAnswer>(*read).regions;
  REQUIRE(regions.size() == 3);
  CHECK(regions[1].region == 1001);
  CHECK(regions[2].region == 1999);
  CHECK(regions[2].hash == 7);
  answer.end = 1500;
  CHECK_FALSE(read_map_message(encode(answer)));
}

}  // namespace
}  // namespace warren::replication
