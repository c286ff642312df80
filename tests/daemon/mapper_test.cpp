// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/mapper.hpp"

#include <atomic>
#include <functional>
#include <future>
#include <mutex>
#include <semaphore>
#include <string>
#include <thread>

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

TEST_CASE("clients that ask without a rest delay each scan that waits by one answer at most") {
  constexpr int kScans = 8;
  std::counting_semaphore<> passes(0);
  std::atomic<int> held{0};
  std::string order;  // of the mapping thread: s a scan, q an answer
  int left = 100;
  Mapper* asked = nullptr;
  // As soon as a client has its answer it asks again.
  const std::function<void(const Mapper::GroundResult&)> ask = [&](const auto&) {
    order += 'q';
    if (--left > 0) (void)asked->ask_ground({}, ask);
  };
  {
    Mapper mapper(MappingConfig{}, {{"lidar", {}}}, kScans,
                  {[&](const QueuedScan&, const ScanReceipt&) { order += 's'; },
                   [&] {
                     ++held;
                     passes.acquire();
                   }});
    asked = &mapper;
    mapper.push(lidar_scan());
    while (held < 1) std::this_thread::yield();
    for (int i = 1; i < kScans; ++i) mapper.push(lidar_scan());
    REQUIRE(mapper.ask_ground({}, ask));
    REQUIRE(mapper.ask_ground({}, ask));
    passes.release(kScans);
  }
  CHECK(order.substr(0, 2 * kScans - 1) == "sqsqsqsqsqsqsqs");
  CHECK(order.find("qqq") != std::string::npos);  // nobody waits for scans that do not come
}

TEST_CASE("ticks come before the questions of clients") {
  std::mutex thread_held;
  std::unique_lock hold(thread_held);
  std::string order;
  {
    Mapper mapper(MappingConfig{}, {{"lidar", {}}}, 8,
                  {[](const QueuedScan&, const ScanReceipt&) {},
                   [&] { const std::lock_guard wait(thread_held); }});
    mapper.push(lidar_scan());
    while (mapper.queue_load().scans > 0) std::this_thread::yield();
    for (std::size_t i = 0; i < Mapper::kMaxCommands; ++i) {
      REQUIRE(mapper.ask_status([&](const MapperStatus&) { order += 'q'; }));
    }
    mapper.ask_changes([&](const auto&) { order += 't'; });
    hold.unlock();
  }
  CHECK(order.find('t') == 0);
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
