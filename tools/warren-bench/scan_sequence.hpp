// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/pose_file.hpp"
#include "core/voxel/scan.hpp"

namespace warren {

struct SequenceSource {
  std::filesystem::path clouds;
  std::optional<std::filesystem::path> poses;  // none: identity
  PoseFormat poses_format = PoseFormat::kKitti;
  std::size_t most_scans = 0;  // 0: all
};

// Scans in the frame of the layer that the first of them opens, as both sides of a comparison take
// them: transformed and filtered beforehand.
struct ScanSequence {
  struct Item {
    Point3f origin_layer;
    std::vector<Point3f> points_layer;
    std::optional<double> time_s{};
  };
  std::vector<Item> scans;
  std::optional<double> max_range_m;
  RejectionCounts rejected{};

  LayerScan scan(std::size_t index) const {
    return {scans[index].origin_layer, scans[index].points_layer, max_range_m, {}};
  }
  std::size_t point_count() const;
  void leave_out_beyond_max_range();
  // The same scans, moved.
  ScanSequence moved_by(const Point3f& offset) const;
};

tl::expected<ScanSequence, std::string> load_sequence(const SequenceSource& source,
                                                      double resolution_m,
                                                      std::optional<double> max_range_m);

}  // namespace warren
