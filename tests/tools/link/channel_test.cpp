// SPDX-License-Identifier: Apache-2.0
#include "tools/link/channel.hpp"

#include <algorithm>
#include <bit>
#include <set>

#include <doctest/doctest.h>

#include "tests/tools/link/link_driver.hpp"

using namespace warren;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kPackets = 50'000;

std::vector<LinkDelivery> pass(const LinkConfig& link, std::size_t packets = kPackets,
                               Duration gap = 1ms, std::uint64_t seed = 1) {
  LinkModelConfig config;
  config.link = link;
  config.seed = seed;
  LinkModel model(config);
  return send_evenly(model, packets, gap);
}

// Lengths of runs of lost packets.
std::vector<std::size_t> bursts(const std::vector<LinkDelivery>& arrived) {
  std::vector<std::size_t> lengths;
  std::size_t next = 0;
  for (const auto& delivery : arrived) {
    if (number_of(delivery) > next) lengths.push_back(number_of(delivery) - next);
    next = number_of(delivery) + 1;
  }
  return lengths;
}

std::size_t overtaken(const std::vector<LinkDelivery>& arrived) {
  std::size_t count = 0;
  std::size_t highest = 0;
  for (const auto& delivery : arrived) {
    count += number_of(delivery) < highest ? 1 : 0;
    highest = std::max(highest, number_of(delivery));
  }
  return count;
}

}  // namespace

TEST_CASE("independent losses have the share asked for, and no memory") {
  for (const double loss : {0.05, 0.2, 0.4}) {
    LinkConfig link;
    link.loss = loss;
    const auto arrived = pass(link);
    const double lost = 1.0 - static_cast<double>(arrived.size()) / kPackets;
    CHECK(std::abs(lost - loss) < 4 * std::sqrt(loss * (1 - loss) / kPackets));
    const double mean = lost * kPackets / static_cast<double>(bursts(arrived).size());
    CHECK(mean == doctest::Approx(1.0 / (1.0 - loss)).epsilon(0.03));
  }
}

TEST_CASE("burst losses have the share and the mean length asked for") {
  LinkConfig link;
  link.burst_loss = BurstLoss{0.2, 20};
  double lost = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto arrived = pass(link, kPackets, 1ms, seed);
    lost += static_cast<double>(kPackets - arrived.size());
    count += static_cast<double>(bursts(arrived).size());
  }
  // About 2500 bursts of geometric length: the mean's deviation is 2 %, the share's the same.
  CHECK(lost / (5.0 * kPackets) == doctest::Approx(0.2).epsilon(0.1));
  CHECK(lost / count == doctest::Approx(20).epsilon(0.1));
}

TEST_CASE("a blackout loses all that is sent in it, and nothing else") {
  LinkConfig link;
  link.blackouts = {{1s, 2s}, {4s, 4500ms}};
  std::set<std::size_t> arrived;
  for (const auto& delivery : pass(link, 6000)) arrived.insert(number_of(delivery));
  for (std::size_t i = 0; i < 6000; ++i) {
    const bool dark = (i >= 1000 && i < 2000) || (i >= 4000 && i < 4500);
    CHECK(arrived.contains(i) != dark);
  }
}

TEST_CASE("a pattern loses what it says, by packets or by time") {
  LinkConfig link;
  link.loss_pattern.lost = {false, true, true};
  CHECK(pass(link, 300).size() == 100);
  link.loss_pattern.slot = 100ms;
  const auto arrived = pass(link, 600);
  REQUIRE(arrived.size() == 200);
  CHECK(number_of(arrived[99]) == 99);
  CHECK(number_of(arrived[100]) == 300);
}

TEST_CASE("loss and delay follow their steps, what a step leaves out stays as configured") {
  LinkConfig link;
  link.delay = 10ms;
  link.steps = {{1s, 1.0, {}}, {2s, 0.0, 50ms}, {3s, {}, 70ms}};
  const auto arrived = pass(link, 4000);
  REQUIRE(arrived.size() == 3000);
  CHECK(arrived[0].at == at_us(10'000));
  CHECK(number_of(arrived[1000]) == 2000);
  CHECK(arrived[1000].at == at_us(2'050'000));
  CHECK(arrived[2000].at == at_us(3'070'000));
}

TEST_CASE("jitter spreads evenly around the delay, and reorders only if asked") {
  LinkConfig link;
  link.delay = 50ms;
  link.jitter = 20ms;
  CHECK(overtaken(pass(link)) == 0);
  link.jitter_reorders = true;
  const auto arrived = pass(link);
  CHECK(overtaken(arrived) > kPackets / 10);
  double sum = 0.0;
  for (const auto& delivery : arrived) {
    const Duration took =
        delivery.at - at_us(1000 * static_cast<std::int64_t>(number_of(delivery)));
    CHECK(took >= 30ms);
    CHECK(took <= 70ms);
    sum += static_cast<double>(took.count());
  }
  CHECK(sum / kPackets == doctest::Approx(50'000).epsilon(0.01));
}

TEST_CASE("a share of packets is overtaken by those sent within the time given") {
  LinkConfig link;
  link.delay = 10ms;
  link.reorder = 0.1;
  link.reorder_by = 5ms;
  const auto arrived = pass(link);
  CHECK(arrived.size() == kPackets);
  CHECK(overtaken(arrived) == doctest::Approx(0.1 * kPackets).epsilon(0.1));
}

TEST_CASE("duplicates and flipped bits have their share") {
  LinkModelConfig config;
  config.link.duplicate = 0.1;
  config.link.corrupt = 0.2;
  LinkModel model(config);
  std::size_t duplicates = 0;
  std::size_t corrupted = 0;
  for (int i = 0; i < 10'000; ++i) {
    auto packet = packet_of(100);
    packet.bytes.assign(100, 0x55);
    model.send(at_us(i), packet);
    while (const auto delivery = model.poll(at_us(i))) {
      duplicates += delivery->duplicate ? 1 : 0;
      corrupted += delivery->corrupted ? 1 : 0;
      int flipped = 0;
      for (const auto byte : delivery->bytes) flipped += std::popcount(unsigned{byte} ^ 0x55U);
      CHECK(flipped <= 8);
      // An even number of flips may undo itself.
      if (!delivery->corrupted) CHECK(flipped == 0);
    }
  }
  CHECK(duplicates == doctest::Approx(1000).epsilon(0.15));
  CHECK(corrupted == doctest::Approx(2200).epsilon(0.1));
}

TEST_CASE("one impairment does not change what another does") {
  LinkConfig link;
  link.loss = 0.2;
  const auto plain = pass(link, 1000);
  link.jitter = 1ms;
  link.delay = 5ms;
  link.duplicate = 0.5;
  link.corrupt = 1e-9;
  std::set<std::size_t> with_others;
  for (const auto& delivery : pass(link, 1000)) with_others.insert(number_of(delivery));
  CHECK(with_others.size() == plain.size());
  for (const auto& delivery : plain) CHECK(with_others.contains(number_of(delivery)));
}
