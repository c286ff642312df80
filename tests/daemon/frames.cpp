// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/frames.hpp"

#include <cstring>

#include "proto/framing.hpp"

namespace warren {

std::string hello_frame() {
  ingest::IngestRequest request;
  request.mutable_hello()->set_protocol_version(1);
  request.mutable_hello()->set_client("test");
  return framed(request.SerializeAsString());
}

ingest::IngestRequest scan_request(std::uint64_t sequence, std::size_t points) {
  ingest::IngestRequest request;
  auto& scan = *request.mutable_scan();
  scan.set_sequence(sequence);
  scan.set_sensor("lidar");
  scan.set_frame_epoch(1);
  scan.set_stamp_ns(static_cast<std::int64_t>(sequence));
  scan.mutable_t_map_base()->set_qw(1.0);
  scan.set_points(static_cast<std::uint32_t>(points));
  return request;
}

std::string payload_of(const std::vector<Point3f>& points) {
  std::string payload(points.size() * sizeof(Point3f), '\0');
  if (!points.empty()) std::memcpy(payload.data(), points.data(), payload.size());
  return payload;
}

std::string scan_frame(std::uint64_t sequence, std::size_t points) {
  return framed(scan_request(sequence, points).SerializeAsString()) +
         payload_of(wall_points(points));
}

std::string pose_update_frame(std::uint64_t frame_epoch, double x_m) {
  ingest::IngestRequest request;
  auto& update = *request.mutable_pose_update();
  update.set_frame_epoch(frame_epoch);
  update.mutable_t_fleet_map()->mutable_translation()->set_x(x_m);
  update.mutable_t_fleet_map()->set_qw(1.0);
  return framed(request.SerializeAsString());
}

std::vector<Point3f> wall_points(std::size_t count) {
  std::vector<Point3f> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i] = {5.05F, 0.1F * static_cast<float>(i % 32), 0.1F * static_cast<float>(i / 32 % 32)};
  }
  return points;
}

}  // namespace warren
