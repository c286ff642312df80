// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/group_rate.hpp"

#include <doctest/doctest.h>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;

constexpr double kSlowest = 1'000.0;
constexpr double kFastest = 50'000.0;

struct Group {
  // An acknowledgement every 10 ms, of packets that waited so long.
  void hear(int acknowledgements, Duration standing) {
    for (int i = 0; i < acknowledgements; ++i) {
      now += milliseconds(10);
      rate.on_acknowledged(now, wanted, standing, kSlowest, kFastest);
    }
  }
  double pace() const { return rate.pace(kSlowest); }

  GroupRate rate;
  bool wanted = false;
  MeshTime now{std::chrono::seconds(100)};
};

}  // namespace

TEST_CASE("what goes to all goes as fast as to the slowest until more is known to pass") {
  Group group;
  CHECK(group.pace() == kSlowest);
  group.wanted = true;
  group.hear(100, milliseconds(0));
  CHECK(group.pace() > 5.0 * kSlowest);
  CHECK(group.pace() < 20.0 * kSlowest);
}

TEST_CASE("without more to send than goes out it does not grow") {
  Group group;
  group.hear(100, milliseconds(0));
  CHECK(group.pace() == kSlowest);
}

TEST_CASE("a queue lowers it, to the pace of the slowest and no further") {
  Group group;
  group.wanted = true;
  group.hear(100, milliseconds(0));
  const double before = group.pace();
  group.hear(30, milliseconds(40));
  CHECK(group.pace() == before);
  group.wanted = false;
  group.hear(30, milliseconds(100));
  CHECK(group.pace() < 0.7 * before);
  group.hear(1000, milliseconds(100));
  CHECK(group.pace() == kSlowest);
}

TEST_CASE("where no queue ever shows it stays near what the fastest is sent") {
  Group group;
  group.wanted = true;
  group.hear(100'000, milliseconds(0));
  CHECK(group.pace() == 4.0 * kFastest);
  // Faster members came into reach: the slowest of them hears it as fast as what goes to it alone.
  CHECK(group.rate.pace(10.0 * kFastest) == 10.0 * kFastest);
}

}  // namespace warren::mesh
