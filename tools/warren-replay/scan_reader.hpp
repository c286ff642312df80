// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/pose_file.hpp"
#include "tools/warren-replay/scan_source.hpp"

namespace warren {

// Reads a recording's clouds ahead in a thread of its own, so that the disk does not slow the
// sending. Holds kAhead scans at most.
class ScanReader : public ScanSource {
 public:
  static constexpr std::size_t kAhead = 4;

  // One pose per file.
  ScanReader(std::vector<std::filesystem::path> files, std::vector<TimedPose> poses,
             const Eigen::Vector3d& gravity_map);
  ~ScanReader() override;
  ScanReader(const ScanReader&) = delete;
  ScanReader& operator=(const ScanReader&) = delete;

  std::size_t count() const override { return files_.size(); }
  tl::expected<std::optional<TimedScan>, std::string> next() override;

 private:
  using Item = tl::expected<TimedScan, std::string>;
  void read_all(const std::stop_token& stop);
  Item read(std::size_t index) const;

  std::vector<std::filesystem::path> files_;
  std::vector<TimedPose> poses_;
  Eigen::Vector3d gravity_map_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Item> ready_;
  std::size_t handed_out_ = 0;
  std::jthread thread_;
};

}  // namespace warren
