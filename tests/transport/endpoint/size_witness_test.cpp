// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/size_witness.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::seconds;

constexpr MeshTime kNow(seconds(9));

TEST_CASE("large packets missing between small ones that came: small from then on") {
  SizeWitness witness;
  PacketSize size;
  for (std::uint64_t number = 0; number < 200; number += 2) {
    witness.on_sent(kNow, number, 1428);
    witness.on_sent(kNow, number + 1, 80);
    AckFrame ack;
    ack.ranges = {{number + 1, number + 2}};
    witness.on_ack(kNow, ack, size);
  }
  CHECK(size.limit(1428) == PacketSize::kSmallBytes);
}

TEST_CASE("what arrives in another order is not lost") {
  SizeWitness witness;
  PacketSize size;
  for (std::uint64_t number = 0; number < 200; ++number) {
    witness.on_sent(kNow, number, 1428);
    AckFrame ack;
    if (number % 2 == 1) ack.ranges = {{number - 1, number + 1}};
    witness.on_ack(kNow, ack, size);
  }
  CHECK(size.limit(1428) == 1428);
}

TEST_CASE("nothing is heard of large ones for long: small probes are worth while") {
  SizeWitness witness;
  PacketSize size;
  for (std::uint64_t number = 0; number < 10; ++number) witness.on_sent(kNow, number, 1428);
  witness.on_time(kNow + seconds(5), Duration{}, size);
  CHECK(size.wants_small_probe());
}

}  // namespace
}  // namespace warren::mesh
