// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/scan_queue.hpp"

#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace warren {
namespace {

QueuedScan scan(std::uint64_t sequence) {
  QueuedScan scan;
  scan.message.sequence = sequence;
  return scan;
}

}  // namespace

TEST_CASE("a full queue drops the oldest and keeps the newest, in order") {
  ScanQueue queue(2);
  CHECK(queue.push(scan(1)).empty());
  CHECK(queue.push(scan(2)).empty());
  const auto dropped = queue.push(scan(3));
  REQUIRE(dropped.size() == 1);
  CHECK(dropped.front().message.sequence == 1);
  CHECK(queue.pop()->message.sequence == 2);
  CHECK(queue.pop()->message.sequence == 3);
  CHECK_FALSE(queue.pop().has_value());
  CHECK(queue.left() == 3);
}

TEST_CASE("a smaller capacity makes room at the next push") {
  ScanQueue queue(4);
  for (std::uint64_t i = 0; i < 4; ++i) queue.push(scan(i));
  queue.set_capacity(2);
  CHECK(queue.push(scan(4)).size() == 3);
  CHECK(queue.size() == 2);
}

TEST_CASE("every scan pushed is dropped, popped or still there, and the order is kept") {
  CHECK(rc::check([](const std::vector<bool>& pushes, std::uint8_t capacity) {
    ScanQueue queue(capacity + 1U);
    std::vector<std::uint64_t> left;
    std::uint64_t pushed = 0;
    for (const bool push : pushes) {
      if (push) {
        for (const auto& dropped : queue.push(scan(pushed++))) {
          left.push_back(dropped.message.sequence);
        }
      } else if (const auto popped = queue.pop()) {
        left.push_back(popped->message.sequence);
      }
      RC_ASSERT(queue.size() <= queue.capacity());
    }
    RC_ASSERT(left.size() + queue.size() == pushed);
    RC_ASSERT(queue.entered() == pushed);
    RC_ASSERT(std::is_sorted(left.begin(), left.end()));
  }));
}

TEST_CASE("stamps order the scans of one sensor in one epoch and nothing else") {
  StampOrder order;
  CHECK(order.advance("front", 1, 100));
  CHECK_FALSE(order.advance("front", 1, 100));
  CHECK_FALSE(order.advance("front", 1, 99));
  CHECK(order.advance("rear", 1, 50));
  CHECK(order.advance("front", 2, 10));
  CHECK_FALSE(order.advance("front", 1, 100));
  CHECK(order.advance("front", 1, 101));
}

TEST_CASE("stamps of long past epochs are forgotten") {
  StampOrder order;
  for (std::uint64_t epoch = 0; epoch <= StampOrder::kEpochsRemembered; ++epoch) {
    CHECK(order.advance("front", epoch, 100));
  }
  CHECK(order.advance("front", 0, 1));
}

}  // namespace warren
