// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_status.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "daemon/fleet/node_book.hpp"
#include "daemon/fleet/own_word.hpp"

namespace warren {
namespace {

using std::chrono::seconds;

const LayerId kLayer{7, 2, 0x1122334455667788};
constexpr std::uint64_t kLog = 0x10;
constexpr std::uint64_t kLaterLog = 0x20;

NodeStatus status_at(std::uint32_t revision, std::int64_t time_us) {
  return {"robot-3", NodeRole::kRobot, time_us,
          NodeStatus::Layer{kLayer, {revision}, 0xABCD, 70'000},
          Eigen::Vector3f(1.5F, -2.0F, 0.25F)};
}

NodeStatus status_of(std::uint32_t layer, std::uint32_t revision, std::int64_t time_us,
                     std::uint64_t incarnation = 0xAA) {
  NodeStatus status = status_at(revision, time_us);
  status.layer->id = {7, layer, incarnation};
  return status;
}

MeshTime at(int s) { return MeshTime(seconds(s)); }

}  // namespace

TEST_CASE("a node's status is read as it was written, with a layer and a position or without") {
  NodeStatus base{"base", NodeRole::kBase, -5, std::nullopt, std::nullopt};
  for (const NodeStatus& status : {status_at(300, 1'700'000'000'000'000), base}) {
    const auto read = read_node_status(encode(status));
    REQUIRE(read.has_value());
    CHECK(*read == status);
  }
  const std::vector<std::uint8_t> golden{0x31, 0x01, 0x04, 'b',  'a',  's',  'e',  0xFB,
                                         0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00};
  CHECK(encode(base) == golden);
}

TEST_CASE("a status cut short, too long, of another version or with a strange name is none") {
  const auto bytes = encode(status_at(300, 17));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_FALSE(read_node_status(std::span(bytes).first(length)).has_value());
  }
  auto longer = bytes;
  longer.push_back(0);
  CHECK_FALSE(read_node_status(longer).has_value());
  for (const int kind : {0x30, 0x32, 0x41}) {
    auto other = bytes;
    other[0] = static_cast<std::uint8_t>(kind);
    CHECK_FALSE(read_node_status(other).has_value());
  }
  for (const std::string& name : {std::string(), std::string("-a"), std::string("a b"),
                                  std::string("\x1b[2J"), std::string(33, 'a')}) {
    NodeStatus status = status_at(1, 1);
    status.name = name;
    CHECK_FALSE(read_node_status(encode(status)).has_value());
  }
  NodeStatus nowhere = status_at(1, 1);
  nowhere.position_fleet->x() = std::nanf("");
  CHECK_FALSE(read_node_status(encode(nowhere)).has_value());
}

TEST_CASE("the book tells when a revision was made, and believes no older word") {
  NodeBook book;
  CHECK(book.read({7}, {kLog, 1}, status_at(10, 1000)));
  CHECK(book.hear({7}, status_at(20, 2000)));
  CHECK_FALSE(book.read({7}, {kLog, 2}, status_at(15, 1500)));
  book.on_silent({7});
  CHECK_FALSE(book.read({7}, {kLog, 3}, status_at(15, 1500)));
  CHECK_FALSE(book.hear({7}, status_at(20, 2000)));
  const NodeBook::Node* const node = book.find({7});
  REQUIRE(node != nullptr);
  CHECK(node->status.layer->revision == Revision{20});
  CHECK_FALSE(node->revisions.time_of({9}).has_value());
  CHECK(node->revisions.time_of({10}) == 1000);
  CHECK(node->revisions.time_of({19}) == 1000);
  CHECK(node->revisions.time_of({500}) == 2000);
  NodeStatus next = status_at(1, 3000);
  next.layer->id.number = 3;
  CHECK(book.hear({7}, next));
  CHECK(node->revisions.time_of({19}) == 3000);
  CHECK(book.find({8}) == nullptr);
}

TEST_CASE("a new layer is believed even though the clock went back") {
  NodeBook book;
  const NodeStatus before = status_of(2, 500, 9'000'000);
  const NodeStatus rebooted = status_of(3, 1, 40);
  SUBCASE("by its own word") {
    CHECK(book.hear({7}, before));
    CHECK(book.hear({7}, rebooted));
    // What others hand on of it is older by now, and the time in it says nothing.
    CHECK_FALSE(book.read({7}, {kLog, 8}, before));
  }
  SUBCASE("by its log, in whatever order that comes") {
    CHECK(book.read({7}, {kLog, 8}, before));
    CHECK(book.read({7}, {kLog, 9}, rebooted));
    CHECK_FALSE(book.read({7}, {kLog, 7}, before));
  }
  CHECK(book.find({7})->status == rebooted);
}

TEST_CASE("a node that lost its disk, and counts its layers from 0 again, is believed") {
  NodeBook book;
  const NodeStatus before = status_of(5, 500, 9'000'000);
  const NodeStatus anew = status_of(0, 1, 40, 0xBB);
  CHECK(book.read({7}, {kLog, 8}, before));
  SUBCASE("at once by its own word, and what its former self wrote counts no more") {
    CHECK(book.hear({7}, anew));
    book.on_silent({7});
    CHECK_FALSE(book.read({7}, {kLog, 9}, before));
  }
  SUBCASE("by its log when that goes on; the former one does not") {
    CHECK_FALSE(book.read({7}, {kLaterLog, 0}, status_of(0, 0, 30, 0xBB)));
    CHECK(book.read({7}, {kLaterLog, 1}, anew));
    CHECK_FALSE(book.read({7}, {kLog, 8}, before));
  }
  CHECK(book.find({7})->status == anew);
}

TEST_CASE("times of very many revisions are thinned, never forgotten at the ends") {
  RevisionTimes times;
  for (std::uint32_t i = 1; i <= 100'000; ++i) times.note({i}, i * 10);
  CHECK(times.time_of({1}) == 10);
  CHECK(times.time_of({100'000}) == 1'000'000);
  const auto middle = times.time_of({50'000});
  REQUIRE(middle.has_value());
  CHECK(*middle <= 500'000);
}

TEST_CASE("nothing is told while nothing but the time changes; the fleet hears less often") {
  OwnWord word(seconds(1));
  const auto first = word.judge(at(100), status_at(1, 1));
  CHECK(first.neighbours);
  CHECK(first.fleet);
  const auto same = word.judge(at(1000), status_at(1, 2));
  CHECK_FALSE(same.neighbours);
  CHECK_FALSE(same.fleet);
  CHECK(word.judge(at(1001), status_at(2, 3)).fleet);
  const auto soon = word.judge(at(1002), status_at(3, 4));
  CHECK_FALSE(soon.neighbours);
  CHECK_FALSE(soon.fleet);
  // What was not told yet is told later, even though nothing changes any more.
  CHECK(word.judge(at(1004), status_at(3, 5)).neighbours);
  const auto later = word.judge(at(1012), status_at(3, 5));
  CHECK_FALSE(later.neighbours);
  CHECK(later.fleet);
  const auto last = word.judge(at(1013), status_at(4, 6), true);
  CHECK(last.neighbours);
  CHECK(last.fleet);
  NodeStatus moved = status_at(4, 7);
  moved.position_fleet->x() += 0.5F;
  CHECK_FALSE(word.judge(at(1020), moved).neighbours);
  moved.position_fleet->x() += 1.0F;
  CHECK(word.judge(at(1021), moved).neighbours);
}

TEST_CASE("neighbours hear of what changes with every tick every fifth time, of a layer at once") {
  OwnWord word(seconds(1));
  int told = 0;
  for (int tick = 0; tick < 100; ++tick) {
    told += word.judge(at(tick), status_at(static_cast<std::uint32_t>(tick), tick)).neighbours;
  }
  CHECK(told == 20);
  NodeStatus other = status_at(101, 101);
  ++other.layer->id.number;
  CHECK(word.judge(at(101), other).neighbours);
  // A slow tick is told each time.
  OwnWord slow(seconds(10));
  for (int tick = 0; tick < 10; ++tick) {
    CHECK(slow.judge(at(10 * tick), status_at(static_cast<std::uint32_t>(tick), tick)).neighbours);
  }
}

}  // namespace warren
