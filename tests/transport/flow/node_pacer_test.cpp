// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/node_pacer.hpp"

#include <map>

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Sends as fast as it may for so long; bytes per peer.
std::map<NodePacer::Peer, double> saturate(NodePacer& pacer,
                                           const std::map<NodePacer::Peer, double>& paces,
                                           Duration span, std::size_t ip_bytes = 1000) {
  std::map<NodePacer::Peer, double> bytes;
  for (const auto& [peer, pace] : paces) pacer.want(peer, true);
  for (MeshTime now{}; now < MeshTime{span}; now += Duration{100}) {
    while (const auto peer = pacer.next(now)) {
      pacer.on_sent(now, *peer, ip_bytes, paces.at(*peer));
      bytes[*peer] += static_cast<double>(ip_bytes);
    }
  }
  return bytes;
}

TEST_CASE("one peer gets its pace") {
  NodePacer pacer(std::nullopt);
  const auto bytes = saturate(pacer, {{1, 100'000.0}}, seconds{10});
  CHECK(bytes.at(1) == doctest::Approx(1'000'000.0).epsilon(0.01));
}

TEST_CASE("peers get equal airtime, whatever their rates") {
  NodePacer pacer(std::nullopt);
  const auto bytes =
      saturate(pacer, {{1, 1'000'000.0}, {2, 100'000.0}, {3, 10'000.0}}, seconds{60});
  CHECK(bytes.at(1) / 1'000'000.0 == doctest::Approx(20.0).epsilon(0.02));
  CHECK(bytes.at(2) / 100'000.0 == doctest::Approx(20.0).epsilon(0.02));
  CHECK(bytes.at(3) / 10'000.0 == doctest::Approx(20.0).epsilon(0.02));
}

TEST_CASE("the interface's ceiling holds for all together") {
  NodePacer pacer(80'000.0);
  const auto bytes = saturate(pacer, {{1, 1e6}, {2, 1e6}}, seconds{20});
  CHECK(bytes.at(1) + bytes.at(2) == doctest::Approx(200'000.0).epsilon(0.02));
}

TEST_CASE("after a rest two packets may go at once, not more") {
  NodePacer pacer(std::nullopt);
  pacer.want(1, true);
  const MeshTime now{seconds{5}};
  CHECK_FALSE(pacer.on_sent(now, 1, 1000, 100'000.0));
  REQUIRE(pacer.next(now));
  CHECK(pacer.on_sent(now, 1, 1000, 100'000.0));
  CHECK_FALSE(pacer.next(now));
  CHECK(pacer.ready_at() == now + milliseconds{10});
}

TEST_CASE("who rested does not starve the others when it comes back") {
  NodePacer pacer(std::nullopt);
  saturate(pacer, {{1, 100'000.0}}, seconds{30});
  pacer.want(2, true);
  double first = 0.0, second = 0.0;
  for (MeshTime now{seconds{30}}; now < MeshTime{seconds{31}}; now += Duration{100}) {
    while (const auto peer = pacer.next(now)) {
      pacer.on_sent(now, *peer, 1000, 100'000.0);
      (*peer == 1 ? first : second) += 1.0;
    }
  }
  CHECK(first >= 45.0);
  CHECK(second >= 45.0);
}

TEST_CASE("what does not wait for its turn does not keep the others from theirs for long") {
  NodePacer pacer(std::nullopt);
  pacer.want(2, true);
  MeshTime now{seconds{1}};
  for (int i = 0; i < 300; ++i) pacer.on_sent(now += milliseconds{10}, 1, 80, 1'000.0);
  CHECK(pacer.ready_at() <= now + milliseconds{250});
  CHECK(pacer.next(now + milliseconds{250}) == NodePacer::Peer{2});
  // A packet alone may last longer.
  now += seconds{1};
  pacer.on_sent(now, 2, 1000, 1'000.0);
  pacer.on_sent(now, 2, 1000, 1'000.0);
  CHECK(pacer.ready_at() == now + seconds{1});
}

TEST_CASE("a peer that wants nothing is never named") {
  NodePacer pacer(std::nullopt);
  pacer.want(1, true);
  pacer.want(1, false);
  CHECK_FALSE(pacer.next(MeshTime{seconds{1}}));
}

}  // namespace
}  // namespace warren::mesh
