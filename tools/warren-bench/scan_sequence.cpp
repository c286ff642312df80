// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/scan_sequence.hpp"

#include <algorithm>
#include <utility>

#include "core/exchange/cloud_reader.hpp"

namespace warren {
namespace {

using Paths = std::vector<std::filesystem::path>;

tl::expected<std::vector<TimedPose>, std::string> poses_of(const SequenceSource& source,
                                                           const Paths& files) {
  if (!source.poses) return std::vector<TimedPose>(files.size());
  const auto poses = read_poses(*source.poses, source.poses_format);
  if (!poses) return tl::unexpected(poses.error());
  return pair_poses(files, *poses);
}

}  // namespace

std::size_t ScanSequence::point_count() const {
  std::size_t count = 0;
  for (const Item& item : scans) count += item.points_layer.size();
  return count;
}

void ScanSequence::leave_out_beyond_max_range() {
  if (!max_range_m) return;
  const double most = *max_range_m * *max_range_m;
  for (Item& item : scans) {
    const Point3f o = item.origin_layer;
    std::erase_if(item.points_layer, [&](const Point3f& p) {
      const double x = p.x - o.x;
      const double y = p.y - o.y;
      const double z = p.z - o.z;
      return x * x + y * y + z * z > most;
    });
  }
}

ScanSequence ScanSequence::moved_by(const Point3f& offset) const {
  const auto move = [&](Point3f& p) { p = {p.x + offset.x, p.y + offset.y, p.z + offset.z}; };
  ScanSequence moved = *this;
  for (Item& item : moved.scans) {
    move(item.origin_layer);
    std::for_each(item.points_layer.begin(), item.points_layer.end(), move);
  }
  return moved;
}

tl::expected<ScanSequence, std::string> load_sequence(const SequenceSource& source,
                                                      double resolution_m,
                                                      std::optional<double> max_range_m) {
  const auto files = list_clouds(source.clouds);
  if (!files) return tl::unexpected(files.error());
  const auto poses = poses_of(source, *files);
  if (!poses) return tl::unexpected(poses.error());

  ScanSequence sequence;
  sequence.max_range_m = max_range_m;
  SensorFilter filter;
  filter.max_range_m = max_range_m;
  ScanPreparer preparer;
  std::optional<LayerOrigin> origin;
  const std::size_t count =
      source.most_scans == 0 ? files->size() : std::min(source.most_scans, files->size());
  for (std::size_t i = 0; i < count; ++i) {
    auto cloud = read_cloud((*files)[i]);
    if (!cloud) return tl::unexpected(cloud.error());
    Scan scan;
    scan.T_map_base = (*poses)[i].T_map_sensor;
    scan.points_sensor = std::move(cloud->points);
    if (!origin) origin = LayerOrigin::snapped(scan.T_map_base.translation, resolution_m);
    if (!origin) return tl::unexpected((*files)[i].string() + ": its pose is not finite");
    const auto prepared = preparer.prepare(scan, filter, *origin, resolution_m, sequence.rejected);
    if (!prepared) return tl::unexpected((*files)[i].string() + ": its pose is not usable");
    sequence.scans.push_back({prepared->origin_layer,
                              {prepared->points_layer.begin(), prepared->points_layer.end()},
                              (*poses)[i].time_s});
  }
  return sequence;
}

}  // namespace warren
