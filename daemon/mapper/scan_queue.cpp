// SPDX-License-Identifier: Apache-2.0
#include "daemon/mapper/scan_queue.hpp"

#include <algorithm>

namespace warren {

std::vector<QueuedScan> ScanQueue::push(QueuedScan scan) {
  std::vector<QueuedScan> dropped;
  while (scans_.size() >= capacity_) {
    auto oldest = pop();
    if (!oldest) break;
    dropped.push_back(std::move(*oldest));
  }
  scans_.push_back(std::move(scan));
  return dropped;
}

std::optional<QueuedScan> ScanQueue::pop() {
  if (scans_.empty()) return std::nullopt;
  QueuedScan oldest = std::move(scans_.front());
  scans_.pop_front();
  ++left_;
  return oldest;
}

bool StampOrder::advance(const std::string& sensor, std::uint64_t frame_epoch,
                         std::int64_t stamp_ns) {
  auto& stamps = last_[sensor];
  const auto known = std::find_if(stamps.begin(), stamps.end(), [&](const LastStamp& last) {
    return last.frame_epoch == frame_epoch;
  });
  if (known == stamps.end()) {
    stamps.push_front({frame_epoch, stamp_ns});
    if (stamps.size() > kEpochsRemembered) stamps.pop_back();
    return true;
  }
  if (stamp_ns <= known->stamp_ns) return false;
  known->stamp_ns = stamp_ns;
  return true;
}

}  // namespace warren
