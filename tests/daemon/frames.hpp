// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/voxel/point.hpp"
#include "warren/ingest.pb.h"

namespace warren {

// What a client of the ingest socket writes.
std::string hello_frame();
ingest::IngestRequest scan_request(std::uint64_t sequence, std::size_t points);
std::string payload_of(const std::vector<Point3f>& points);
// A scan that sees a wall 5 m ahead, its stamp is its sequence.
std::string scan_frame(std::uint64_t sequence, std::size_t points = 64);
std::string pose_update_frame(std::uint64_t frame_epoch, double x_m);

// A wall of points across the x axis.
std::vector<Point3f> wall_points(std::size_t count);

}  // namespace warren
