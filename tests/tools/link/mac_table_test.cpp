// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-link/mac_table.hpp"

#include <vector>

#include <doctest/doctest.h>

using namespace warren;

namespace {

std::vector<std::uint8_t> frame(std::uint8_t to, std::uint8_t from) {
  return {2, 0, 0, 0, 0, to, 2, 0, 0, 0, 0, from, 8, 0};
}

}  // namespace

TEST_CASE("a frame floods until its address has been heard, then it goes there alone") {
  MacTable table;
  CHECK(table.route(0, frame(7, 1)) == kEveryStation);
  CHECK(table.route(4, frame(1, 7)) == 0);
  CHECK(table.route(0, frame(7, 1)) == 4);
}

TEST_CASE("an address that moves is followed") {
  MacTable table;
  table.route(3, frame(9, 1));
  table.route(5, frame(9, 1));
  CHECK(table.route(0, frame(1, 2)) == 5);
}

TEST_CASE("group frames flood, and no group is learnt as a sender") {
  MacTable table;
  auto broadcast = frame(1, 1);
  std::fill_n(broadcast.begin(), 6, std::uint8_t{0xFF});
  CHECK(table.route(0, broadcast) == kEveryStation);
  auto from_group = frame(1, 1);
  from_group[6] = 0x33;
  table.route(3, from_group);
  auto to_group = frame(1, 2);
  to_group[0] = 0x33;
  CHECK(table.route(0, to_group) == kEveryStation);
}
