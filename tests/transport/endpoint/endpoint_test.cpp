// SPDX-License-Identifier: Apache-2.0
// What an endpoint promises to the layer above, without any other node.
#include "transport/endpoint/endpoint.hpp"

#include <set>
#include <string>

#include <doctest/doctest.h>

#include "transport/delivery/saved_parcels.hpp"

namespace warren::mesh {
namespace {

using std::chrono::seconds;

constexpr MeshTime kNow(seconds(5));
const std::vector<std::uint8_t> kBytes(100, 7);

struct NoMap : MapSource {
  std::optional<Packet> next_for(MemberId, MapClass, std::size_t) override { return {}; }
  void on_acknowledged(MemberId, std::uint64_t) override {}
  void on_lost(MemberId, std::uint64_t) override {}
};

EndpointConfig config_of(std::uint64_t boot) {
  EndpointConfig config;
  config.self = {1};
  config.boot = {boot};
  config.interfaces.resize(1);
  return config;
}

struct Node1 {
  explicit Node1(const EndpointConfig& config)
      : endpoint(config, std::make_shared<PresharedKeys>(Key{7}), map) {}
  NoMap map;
  Endpoint endpoint;
};

TEST_CASE("two lives with the same seed do not draw the same streams") {
  Node1 first(config_of(10));
  Node1 second(config_of(11));
  const auto a = first.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, kBytes);
  const auto b = second.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, kBytes);
  REQUIRE(a);
  REQUIRE(b);
  CHECK(a->stream != b->stream);
  CHECK(a->number == 0);
}

TEST_CASE("what was saved is restored, with a gap in the numbers of parcels") {
  Node1 first(config_of(10));
  const auto key = first.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, kBytes);
  REQUIRE(key);
  Node1 second(config_of(11));
  REQUIRE(second.endpoint.restore(first.endpoint.save()));
  const auto next = second.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, kBytes);
  REQUIRE(next);
  CHECK(next->stream == key->stream);
  CHECK(next->number > key->number + 1);
}

TEST_CASE("restoring is all or nothing") {
  Node1 first(config_of(10));
  for (std::uint32_t id = 2; id <= 5; ++id) {
    REQUIRE(first.endpoint.send_parcel(kNow, {id}, ParcelClass::kMessage, kBytes));
  }
  auto saved = first.endpoint.save();
  EndpointConfig small = config_of(11);
  small.members_max = 3;
  Node1 second(small);
  const auto nothing = second.endpoint.save();
  CHECK(!second.endpoint.restore(saved));
  CHECK(second.endpoint.save() == nothing);
  saved[saved.size() / 2] ^= 1U;
  Node1 third(config_of(12));
  CHECK(!third.endpoint.restore(saved));
  CHECK(third.endpoint.save() == nothing);
}

TEST_CASE("a parcel that is too large, or beyond the memory for parcels, is refused and counted") {
  EndpointConfig config = config_of(10);
  config.parcels_bytes_max = 10'000;
  Node1 node(config);
  const std::vector<std::uint8_t> large(ParcelFrame::kBytesMax + 1);
  CHECK(node.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, large) ==
        tl::unexpected(SendError::kTooLarge));
  std::size_t taken = 0;
  while (node.endpoint.send_parcel(kNow, {2}, ParcelClass::kMessage, kBytes)) ++taken;
  CHECK(taken > 5);
  CHECK(taken * kBytes.size() <= config.parcels_bytes_max);
  CHECK(node.endpoint.counts().outbox.parcels_refused == 2);
}

template <typename Names>
void check_names(const Names& names) {
  std::set<std::string> seen;
  for (const char* name : names) {
    REQUIRE(name != nullptr);
    CHECK(seen.insert(name).second);
  }
}

TEST_CASE("every count has a name of its own") {
  check_names(kUnusedNames);
  check_names(kSentClassNames);
  std::set<std::string> names;
  OutboxCounts sum;
  OutboxCounts one;
  for (const auto& [name, count] : kOutboxCounts) {
    CHECK(names.insert(name).second);
    one.*count = names.size();
  }
  sum += one;
  sum += one;
  std::uint64_t expected = 0;
  for (const auto& [name, count] : kOutboxCounts) CHECK(sum.*count == 2 * ++expected);
  names.clear();
  for (const auto& [name, count] : kInboxCounts) CHECK(names.insert(name).second);
}

}  // namespace
}  // namespace warren::mesh
