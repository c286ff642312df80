// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <doctest/doctest.h>

#include "daemon/replication/replication.hpp"

namespace warren::replication {
namespace {

const LayerId kOwn{7, 0, 0xAA};
constexpr MemberId kOther{8};

// What another member says that it holds of it.
void announce(Replication& replication, std::uint32_t revision) {
  Announcement said;
  said.layer = kOwn;
  said.resolution = kDefaultResolution;
  said.hops = 1;
  said.holdings = Holdings{Revision{revision}};
  replication.on_event(MeshTime{}, mesh::TelemetryArrived{kOther, kLayerKeys, encode(said)});
}

}  // namespace

TEST_CASE("a store that is older than what has left the node shows by what others hold") {
  Replica layer(kOwn, kDefaultResolution);
  layer.publish(std::vector<CodedBlock>{});
  layer.publish(std::vector<CodedBlock>{});
  const Revision known = layer.holdings().at(0);
  ReplicationConfig config;
  config.self = MemberId{7};
  Replication replication(config);
  REQUIRE(replication.add_own(layer));
  replication.on_event(MeshTime{}, mesh::MemberUp{kOther});
  announce(replication, known.number);
  CHECK(replication.ahead_of_us().empty());
  announce(replication, known.number + 3);
  announce(replication, known.number + 4);
  REQUIRE(replication.ahead_of_us().contains(kOwn));
  const HeldAhead& ahead = replication.ahead_of_us().at(kOwn);
  CHECK(ahead.holder == kOther);
  CHECK(ahead.held.number == known.number + 3);
  CHECK(ahead.known == known);
}

}  // namespace warren::replication
