// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/natural_order.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace warren;

TEST_CASE("digits in names are numbers of any length") {
  const std::vector<std::string> sorted = {"",
                                           "a",
                                           "a01",
                                           "a1",
                                           "a2",
                                           "a2b",
                                           "a10",
                                           "b1.5",
                                           "b1.10",
                                           "full2",
                                           "full99999999999999999998",
                                           "full99999999999999999999"};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = 0; j < sorted.size(); ++j) {
      CAPTURE(sorted[i]);
      CAPTURE(sorted[j]);
      CHECK(natural_less(sorted[i], sorted[j]) == (i < j));
    }
  }
  std::vector<std::string> shuffled = sorted;
  std::mt19937 random(1);
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  std::sort(shuffled.begin(), shuffled.end(), natural_less);
  CHECK(shuffled == sorted);
}

TEST_CASE("the last number in a name is found") {
  CHECK(last_number_in("full12") == 12);
  CHECK(last_number_in("cloud.00007_ds") == 7);
  CHECK(last_number_in("2024-run3-000") == 0);
  CHECK_FALSE(last_number_in("cloud"));
  CHECK_FALSE(last_number_in(""));
  CHECK_FALSE(last_number_in("t1234567890123456789"));
}
