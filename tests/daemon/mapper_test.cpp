// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/mapper.hpp"

#include <doctest/doctest.h>

namespace warren {

TEST_CASE("questions and pose updates without end are refused, and those that wait are answered") {
  std::mutex thread_held;
  std::atomic<std::size_t> answers{0};
  std::unique_lock hold(thread_held);
  {
    Mapper mapper(SelfMapConfig{}, {{"lidar", {}}}, 8,
                  {[](const QueuedScan&, const ScanReceipt&) {},
                   [&] { const std::lock_guard wait(thread_held); }});
    QueuedScan scan;
    scan.message.sensor = "lidar";
    mapper.push(std::move(scan));
    while (mapper.queue_load().scans > 0) std::this_thread::yield();  // now it is held
    for (std::size_t i = 0; i < Mapper::kMaxCommands; ++i) {
      REQUIRE(mapper.ask_status([&](const MapperStatus&) { ++answers; }));
      REQUIRE(mapper.update_pose({}, [&](bool) { ++answers; }));
    }
    CHECK_FALSE(mapper.ask_status([&](const MapperStatus&) { ++answers; }));
    CHECK_FALSE(mapper.ask_snapshot([&](const auto&) { ++answers; }));
    CHECK_FALSE(mapper.update_pose({}, [&](bool) { ++answers; }));
    CHECK(answers == 0);
    hold.unlock();
  }
  CHECK(answers == 2 * Mapper::kMaxCommands);
}

}  // namespace warren
