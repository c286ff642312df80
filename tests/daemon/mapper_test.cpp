// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/mapper.hpp"

#include <future>
#include <semaphore>

#include <doctest/doctest.h>

namespace warren {
namespace {

QueuedScan lidar_scan() {
  QueuedScan scan;
  scan.message.sensor = "lidar";
  return scan;
}

}  // namespace

TEST_CASE("questions and pose updates without end are refused, and those that wait are answered") {
  std::mutex thread_held;
  std::atomic<std::size_t> answers{0};
  std::unique_lock hold(thread_held);
  {
    Mapper mapper(MappingConfig{}, {{"lidar", {}}}, 8,
                  {[](const QueuedScan&, const ScanReceipt&) {},
                   [&] { const std::lock_guard wait(thread_held); }});
    mapper.push(lidar_scan());
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

TEST_CASE("status is answered while a pose update waits for scans") {
  std::counting_semaphore<> passes(0);
  std::atomic<int> held{0};
  std::atomic<bool> moved{false};
  Mapper mapper(MappingConfig{}, {{"lidar", {}}}, 8,
                {[](const QueuedScan&, const ScanReceipt&) {},
                 [&] {
                   ++held;
                   passes.acquire();
                 }});
  mapper.push(lidar_scan());
  mapper.push(lidar_scan());
  while (held < 1) std::this_thread::yield();
  std::promise<MapperStatus> answer;
  REQUIRE(mapper.update_pose({}, [&](bool) { moved = true; }));
  REQUIRE(mapper.ask_status([&](const MapperStatus& status) { answer.set_value(status); }));
  passes.release();  // the second scan is held from now on; the pose update waits for it
  CHECK(answer.get_future().get().scans <= 1);
  CHECK_FALSE(moved);
  passes.release();
  mapper.finish([](const auto&) {});
}

}  // namespace warren
