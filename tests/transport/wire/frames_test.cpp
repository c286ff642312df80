// SPDX-License-Identifier: Apache-2.0
#include "transport/wire/frames.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "tests/transport/wire/random_frames.hpp"
#include "transport/wire/envelope.hpp"

using namespace warren;
using namespace warren::mesh;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encode_all(const std::vector<Frame>& frames) {
  Bytes content;
  for (const Frame& frame : frames) append(content, frame);
  return content;
}

std::vector<Frame> random_frames(test::Random& random) {
  std::vector<Frame> frames;
  for (std::size_t count = random() % 6; count > 0; --count) {
    frames.push_back(test::random_inner_frame(random));
  }
  frames.push_back(test::random_frame(random));
  return frames;
}

ParcelFrame parcel(std::uint32_t offset, std::uint32_t total, std::size_t size) {
  return {{7, 20}, ParcelClass::kMessage, 20, total, offset, Bytes(size, 0xAB)};
}

}  // namespace

TEST_CASE(
    "frames come back from a packet's content, and take the bytes that they are said to take") {
  CHECK(rc::check("round trip", [](std::uint64_t seed) {
    test::Random random(seed);
    const std::vector<Frame> frames = random_frames(random);
    std::size_t bytes = 0;
    for (const Frame& frame : frames) bytes += encoded_bytes(frame);
    const Bytes content = encode_all(frames);
    RC_ASSERT(content.size() == bytes);
    RC_ASSERT(read_frames(content) == frames);
  }));
}

TEST_CASE("frames have one form: a bit changed means refusal or other frames that say just that") {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    test::Random random(seed);
    const std::vector<Frame> frames{test::random_inner_frame(random), test::random_frame(random)};
    const Bytes content = encode_all(frames);
    for (std::size_t bit = 0; bit < content.size() * 8; ++bit) {
      Bytes flipped = content;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      const auto read = read_frames(flipped);
      if (!read) continue;
      REQUIRE(*read != frames);
      REQUIRE(encode_all(*read) == flipped);
    }
  }
}

TEST_CASE("random bytes are refused, or are what their frames encode to") {
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    test::Random random(seed);
    Bytes content = test::random_bytes(random, random() % 40);
    if (!content.empty() && random() % 2 == 0)
      content[0] = static_cast<std::uint8_t>(random() % 11);
    const auto read = read_frames(content);
    if (!read) continue;
    ++taken;
    REQUIRE(read->size() <= content.size());
    REQUIRE(encode_all(*read) == content);
  }
  CHECK(taken > 500);
}

TEST_CASE("a frame that is cut short is refused, but for a map frame, which ends with its packet") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    test::Random random(seed);
    const Bytes content = encode_all({test::random_inner_frame(random)});
    for (std::size_t length = 1; length < content.size(); ++length) {
      REQUIRE_FALSE(read_frames(std::span(content).first(length)));
    }
  }
  const Bytes map = encode_all({MapFrame{MapClass::kFresh, {1, 2, 3}}});
  for (std::size_t length = 1; length <= map.size(); ++length) {
    CHECK(encode_all(*read_frames(std::span(map).first(length))).size() == length);
  }
  CHECK(read_frames({})->empty());
}

TEST_CASE("what a frame costs") {
  CHECK(encoded_bytes(MapFrame{MapClass::kBacklog, Bytes(1000)}) == 1001);
  CHECK(encoded_bytes(parcel(0, 100, 100)) == 111);
  CHECK(encoded_bytes(parcel(900'000, 901'000, 1000)) == 1015);
  CHECK(encoded_bytes(parcel(1000, 1'000'000, 1000)) == 1017);
  CHECK(encoded_bytes(HelloFrame{{3}, true}) == 2);
  CHECK(encoded_bytes(AckFrame{{{0, 100}}, 5, Duration(20), 0, 0}) == 17);
  const std::uint32_t far = 0xFFFFFFFF;
  const ParcelFrame dear{{1, far}, ParcelClass::kControl, 0, 1'000'000, 1, Bytes(20000)};
  CHECK(encoded_bytes(dear) == 20000 + ParcelFrame::kOverheadMax);
  CHECK(encoded_bytes(UrgentFrame{far, Bytes(64)}) <= 64 + UrgentFrame::kOverheadMax);
  CHECK(encoded_bytes(TelemetryFrame{0xFFFF, far, Bytes(1000)}) ==
        1000 + TelemetryFrame::kOverheadMax);
}

TEST_CASE("limits: what reaches them is read, what is beyond them is not") {
  const auto takes = [](const Frame& frame) {
    return read_frames(encode_all({frame})) == std::vector<Frame>{frame};
  };
  const auto padded = [](Bytes start, std::size_t size) {
    start.resize(start.size() + size);
    return start;
  };
  CHECK(takes(UrgentFrame{1, Bytes(64)}));
  CHECK_FALSE(read_frames(padded({5, 1, 65}, 65)));
  CHECK(takes(TelemetryFrame{1, 1, Bytes(1000)}));
  CHECK_FALSE(read_frames(padded({6, 1, 1, 0xE9, 0x07}, 1001)));
  CHECK(takes(parcel(999'999, 1'000'000, 1)));
  CHECK(takes(PingFrame{0xFFFF}));

  AckFrame ack{{{kPacketNumberEnd - 1, kPacketNumberEnd}},
               0xFFFFFFFF,
               Duration(0xFFFFFFFF),
               0xFFFFFFFF,
               0xFFFFFFFF};
  CHECK(takes(ack));
  while (ack.ranges.size() < AckFrame::kRangesMax) {
    const std::uint64_t below = ack.ranges.back().first;
    ack.ranges.push_back({below - 2, below - 1});
  }
  CHECK(takes(ack));
  Bytes too_many = encode_all({ack});
  too_many[1] = AckFrame::kRangesMax + 1;
  too_many.insert(too_many.begin() + 10, {0, 0});
  CHECK_FALSE(read_frames(too_many));
}

TEST_CASE("malformed frames are refused") {
  const auto refused = [](const Bytes& content) { return !read_frames(content).has_value(); };
  CHECK(refused({0}));
  CHECK(refused({11}));
  CHECK(refused({0x7F}));
  CHECK(refused({1, 0x80, 0x00}));                    // a number not in its shortest form
  CHECK(refused({1, 0x80, 0x80, 0x80, 0x80, 0x10}));  // a member above 2^32 - 1
  CHECK(refused({3, 0}));                             // nothing acknowledged
  const auto ack = [](Bytes ranges) {
    ranges.resize(ranges.size() + 13);
    return ranges;
  };
  CHECK(refused(ack({3, 1, 4, 5})));        // a range that begins below 0
  CHECK(refused(ack({3, 2, 4, 2, 1, 0})));  // the second one lies below 0
  CHECK_FALSE(refused(ack({3, 2, 4, 2, 0, 0})));
  CHECK(refused({4, 2, 0, 1}));                          // padding that is not 0
  CHECK(refused({0xB0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0}));  // a form that there is none of
  CHECK(refused({0x81, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0}));  // finished before number -1
  const Bytes key{1, 1, 1, 1, 1, 1, 1, 1, 0};
  const auto with = [&](std::uint8_t type, const Bytes& rest) {
    Bytes content{type};
    content.insert(content.end(), key.begin(), key.end());
    content.insert(content.end(), rest.begin(), rest.end());
    return content;
  };
  CHECK(refused(with(0x90, {0, 0, 0x10, 0, 0, 9})));        // all of a parcel, as a tail
  CHECK(refused(with(0xA0, {1, 0, 0x30, 0, 0, 2, 9, 9})));  // a tail, as a part
  CHECK(refused(with(0xA0, {4, 0, 0x30, 0, 0, 0})));        // begins beyond the end
  CHECK_FALSE(refused(with(0xA0, {1, 0, 0x30, 0, 0, 1, 9})));
  CHECK_FALSE(refused(with(0x90, {1, 0, 0x30, 0, 0, 9, 9})));
  CHECK(refused(with(7, {1, 0xC0, 0x84, 0x3D, 0})));  // bytes beyond the largest parcel
  CHECK_FALSE(refused(with(7, {1, 0xBF, 0x84, 0x3D, 0})));
}
