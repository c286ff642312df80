// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/subscription.hpp"

#include "tests/core/layer/replica_steps.hpp"

namespace warren::replication {
namespace {

using test::block_with;
using test::kLayer;

constexpr BlockOrdinal kFirst = 600;
constexpr BlockOrdinal kApart = 300;

// A provider with some blocks, and a member that holds nothing at first.
struct Pair {
  Replica provider{kLayer, kDefaultResolution};
  Replica member{kLayer, kDefaultResolution};
  Subscription subscription;
  std::uint64_t ticket = 0;
  std::uint64_t wishes = 0;

  // Not a small one: with much free space before these blocks.
  explicit Pair(std::size_t blocks, bool small = false) {
    test::Random random(blocks);
    std::vector<CodedBlock> all;
    BlockCodes free;
    free.known.fill(kFullCell);
    for (BlockOrdinal block = 0; block < 500 && !small; ++block) {
      all.push_back({block, CodeBlock(free)});
    }
    for (std::size_t i = 0; i < blocks; ++i) {
      all.push_back({kFirst + i * kApart, CodeBlock(test::random_codes(random, 30))});
    }
    test::publish(provider, all);
  }
  void wish(bool lost = false, KeySet keys = {}) {
    Wish wish{0, ++wishes, true, lost, member.holdings(), std::move(keys)};
    CHECK(subscription.on_wish(wish, provider));
  }
  void touch(BlockOrdinal block, std::uint32_t place) {
    test::publish(provider, {block_with(block, place, VoxelCode::occupied(2, false))});
  }
  std::optional<DiffPacket> next(bool fresh) {
    auto packet =
        fresh ? subscription.next_fresh(provider, 1000) : subscription.next_backlog(provider, 1000);
    if (packet) subscription.on_sent(++ticket, packet->claim);
    return packet;
  }
  void deliver(const DiffPacket& packet) {
    CHECK(member.apply(kLayer, packet.bytes) == ApplyResult::kApplied);
  }
  // Sends, delivers and acknowledges all; how many packets that took.
  std::size_t catch_up() {
    std::size_t packets = 0;
    while (auto packet = next(false)) {
      deliver(*packet);
      subscription.on_acknowledged(ticket);
      ++packets;
    }
    return packets;
  }
  bool equal() const { return member.digest().root() == provider.digest().root(); }
};

TEST_CASE("nothing is sent to who wants nothing") {
  Pair pair(10);
  CHECK_FALSE(pair.next(false));
  pair.wish();
  CHECK(pair.next(false));
  CHECK(pair.subscription.on_wish({0, 9, false, false, Holdings(), KeySet{}}, pair.provider));
  CHECK_FALSE(pair.next(false));
}

TEST_CASE("a wish that is older than the last changes nothing") {
  Pair pair(3);
  pair.wish();
  pair.wish();
  CHECK_FALSE(pair.subscription.on_wish({0, 1, false, false, Holdings(), KeySet{}}, pair.provider));
  CHECK(pair.next(false));
}

TEST_CASE("a newcomer gets all as backlog, each key once, then ticks as fresh") {
  Pair pair(60);
  pair.wish();
  CHECK_FALSE(pair.next(true));
  const std::size_t packets = pair.catch_up();
  CHECK(packets > 3);
  CHECK(pair.equal());
  pair.touch(kFirst, 5);
  CHECK_FALSE(pair.next(false));
  const auto tick = pair.next(true);
  REQUIRE(tick);
  CHECK(tick->claim == Claim{{}, Revision{1}, Revision{2}});
  CHECK_FALSE(pair.next(true));
}

TEST_CASE(
    "of a small layer a newcomer gets all as fresh, and later what it lacks after a silence") {
  Pair pair(60, true);
  pair.wish();
  CHECK_FALSE(pair.next(false));
  while (auto packet = pair.next(true)) {
    pair.deliver(*packet);
    pair.subscription.on_acknowledged(pair.ticket);
  }
  CHECK(pair.equal());
  pair.touch(kFirst, 7);
  pair.subscription.raise_goal(pair.provider);
  CHECK_FALSE(pair.next(true));
  CHECK(pair.next(false));
}

TEST_CASE("what is unacknowledged is in the next tick too, and what is lost goes again") {
  Pair pair(2);
  pair.wish();
  pair.catch_up();
  pair.touch(kFirst, 5);
  const auto lost = pair.next(true);
  const std::uint64_t lost_ticket = pair.ticket;
  pair.touch(kFirst, 6);
  const auto next = pair.next(true);
  REQUIRE(lost);
  REQUIRE(next);
  CHECK(next->claim.from == Revision{1});
  pair.deliver(*next);
  pair.subscription.on_lost(lost_ticket);
  CHECK_FALSE(pair.next(true));
  pair.subscription.on_lost(pair.ticket);
  CHECK(pair.next(true)->claim.from == Revision{1});
  CHECK(pair.equal());
}

TEST_CASE("a packet told lost may have come late") {
  Pair pair(2);
  pair.wish();
  const auto packet = pair.next(false);
  pair.deliver(*packet);
  pair.subscription.on_lost(pair.ticket);
  pair.subscription.on_acknowledged(pair.ticket);
  CHECK_FALSE(pair.next(false));
  CHECK(pair.subscription.believed() == pair.member.holdings());
}

TEST_CASE("if the worst is lost, the member's holdings still have room") {
  Pair pair(2000);
  pair.wish();
  std::vector<std::uint64_t> flying;
  std::vector<DiffPacket> packets;
  while (auto packet = pair.next(false)) {
    packets.push_back(*packet);
    flying.push_back(pair.ticket);
  }
  CHECK(packets.size() > 40);
  for (std::size_t i = 1; i < packets.size(); i += 2) {
    pair.deliver(packets[i]);
    pair.subscription.on_acknowledged(flying[i]);
  }
  for (std::size_t i = 0; i < packets.size(); i += 2) pair.subscription.on_lost(flying[i]);
  CHECK(pair.subscription.believed() == pair.member.holdings());
  pair.catch_up();
  CHECK(pair.equal());
}

TEST_CASE("acknowledgements of before a wish that tells of a loss count no more") {
  Pair pair(2);
  pair.wish();
  pair.catch_up();
  pair.touch(kFirst, 5);
  CHECK(pair.next(true));
  const std::uint64_t believed_lost = pair.ticket;
  pair.wish(true);
  pair.subscription.on_acknowledged(believed_lost);
  const auto again = pair.next(true);
  REQUIRE(again);
  pair.deliver(*again);
  CHECK(pair.equal());
}

TEST_CASE("who wants some keys gets no others") {
  Pair pair(60);
  pair.wish(false, KeySet{{{3000, 6000}, {9000, 9300}}});
  while (auto packet = pair.next(false)) {
    const bool inside = (packet->claim.keys.first >= 3000 && packet->claim.keys.end <= 6000) ||
                        (packet->claim.keys.first >= 9000 && packet->claim.keys.end <= 9300);
    CHECK(inside);
    pair.deliver(*packet);
    pair.subscription.on_acknowledged(pair.ticket);
  }
  CHECK(pair.member.holdings().lowest({3000, 6000}) == Revision{1});
  CHECK(pair.member.holdings().at(7000) == Revision{});
}

TEST_CASE("after a silence what is lacking is backlog") {
  Pair pair(5);
  pair.wish();
  pair.catch_up();
  pair.touch(kFirst, 7);
  pair.subscription.raise_goal(pair.provider);
  CHECK_FALSE(pair.next(true));
  CHECK(pair.next(false));
}

TEST_CASE("a packet is as small as the link wants it") {
  Pair pair(60);
  pair.wish();
  std::size_t packets = 0;
  while (auto packet = pair.subscription.next_backlog(pair.provider, 250)) {
    CHECK(packet->bytes.size() <= 250);
    pair.subscription.on_sent(++pair.ticket, packet->claim);
    pair.deliver(*packet);
    pair.subscription.on_acknowledged(pair.ticket);
    ++packets;
  }
  CHECK(packets > 10);
  CHECK(pair.equal());
}

}  // namespace
}  // namespace warren::replication
