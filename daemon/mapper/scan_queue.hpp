// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/ingest/messages.hpp"

namespace warren {

enum class ClientId : std::uint64_t {};

struct QueuedScan {
  ClientId client{};
  ScanMessage message;
};

// Scans on their way to the map, oldest first. When full, the oldest makes room: a planner wants
// what is new. Not synchronised.
class ScanQueue {
 public:
  // At least one.
  explicit ScanQueue(std::size_t capacity) : capacity_(capacity) {}

  // Those that made room.
  std::vector<QueuedScan> push(QueuedScan scan);
  // The oldest; nothing when empty.
  std::optional<QueuedScan> pop();
  // A smaller capacity makes room at the next push.
  void set_capacity(std::size_t capacity) { capacity_ = capacity; }

  std::size_t size() const { return scans_.size(); }
  std::size_t capacity() const { return capacity_; }
  // How many scans have left the queue, either way; and how many ever entered it.
  std::uint64_t left() const { return left_; }
  std::uint64_t entered() const { return left_ + scans_.size(); }

 private:
  std::deque<QueuedScan> scans_;
  std::size_t capacity_;
  std::uint64_t left_ = 0;
};

// Knows the last stamp of each sensor in its latest frame epochs.
class StampOrder {
 public:
  static constexpr std::size_t kEpochsRemembered = 4;

  // True, and remembered, if the stamp is after all earlier ones of this sensor in this epoch.
  bool advance(const std::string& sensor, std::uint64_t frame_epoch, std::int64_t stamp_ns);

 private:
  struct LastStamp {
    std::uint64_t frame_epoch;
    std::int64_t stamp_ns;
  };
  std::map<std::string, std::deque<LastStamp>> last_;  // per sensor, latest epoch first
};

}  // namespace warren
