// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/packet_size.hpp"

#include <doctest/doctest.h>

#include "transport/endpoint/jitter.hpp"

namespace warren::mesh {
namespace {

using std::chrono::seconds;

constexpr MeshTime kNow(seconds(50));

TEST_CASE("large ones lost while small ones pass: small packets from then on") {
  PacketSize size;
  for (int i = 0; i < 40; ++i) {
    size.on_lost(kNow, 1428);
    if (size.wants_small_probe()) {
      size.on_small_probe();
      size.on_passed(80);
    }
  }
  CHECK(size.limit(1428) == PacketSize::kSmallBytes);
}

TEST_CASE("everything lost is no reason for small packets") {
  PacketSize size;
  for (int i = 0; i < 1000; ++i) {
    size.on_lost(kNow, 1428);
    size.on_lost(kNow, 80);
  }
  CHECK(size.limit(1428) == 1428);
}

TEST_CASE("a large probe that passes ends it") {
  PacketSize size;
  for (int i = 0; i < 40; ++i) {
    size.on_lost(kNow, 1428);
    size.on_passed(80);
  }
  REQUIRE(size.limit(1428) < 1428);
  CHECK_FALSE(size.wants_large_probe(kNow));
  const MeshTime later = kNow + PacketSize::kProbeAgain;
  REQUIRE(size.wants_large_probe(later));
  size.on_large_probe(later);
  CHECK_FALSE(size.wants_large_probe(later));
  size.on_passed(1428);
  CHECK(size.limit(1428) == 1428);
}

TEST_CASE("independent loss of 40 % is hardly ever taken for it") {
  PacketSize size;
  Jitter random(5);
  int small = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool lost = random.bits() % 100 < 40;
    const std::size_t bytes = size.wants_small_probe() ? 80 : 1428;
    if (bytes == 80) size.on_small_probe();
    if (lost) {
      size.on_lost(kNow, bytes);
    } else {
      size.on_passed(bytes);
    }
    if (size.limit(1428) < 1428) ++small;
  }
  CHECK(small < 20);
}

}  // namespace
}  // namespace warren::mesh
