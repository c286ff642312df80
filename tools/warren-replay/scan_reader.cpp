// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-replay/scan_reader.hpp"

#include <cassert>
#include <utility>

#include "core/exchange/cloud_reader.hpp"

namespace warren {

ScanReader::ScanReader(std::vector<std::filesystem::path> files, std::vector<TimedPose> poses,
                       const Eigen::Vector3d& gravity_map)
    : files_(std::move(files)),
      poses_(std::move(poses)),
      gravity_map_(gravity_map),
      thread_([this](const std::stop_token& stop) { read_all(stop); }) {
  assert(files_.size() == poses_.size());
}

ScanReader::~ScanReader() = default;

tl::expected<std::optional<TimedScan>, std::string> ScanReader::next() {
  if (handed_out_ == files_.size()) return std::nullopt;
  ++handed_out_;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ready_.empty(); });
  Item item = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  if (!item) return tl::unexpected(item.error());
  return std::move(*item);
}

void ScanReader::read_all(const std::stop_token& stop) {
  for (std::size_t index = 0; index < files_.size(); ++index) {
    Item item = read(index);
    std::unique_lock lock(mutex_);
    const bool room = changed_.wait(lock, stop, [this] { return ready_.size() < kAhead; });
    if (!room) return;
    ready_.push_back(std::move(item));
    changed_.notify_all();
  }
}

ScanReader::Item ScanReader::read(std::size_t index) const {
  auto cloud = read_cloud(files_[index]);
  if (!cloud) return tl::unexpected(cloud.error());
  TimedScan recorded;
  recorded.scan.T_map_base = poses_[index].T_map_sensor;
  recorded.scan.gravity_map = gravity_map_;
  recorded.scan.points_sensor = std::move(cloud->points);
  recorded.time_s = poses_[index].time_s;
  return recorded;
}

}  // namespace warren
