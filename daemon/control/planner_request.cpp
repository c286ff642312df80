// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/planner_request.hpp"

#include <cmath>

#include "daemon/control/decoded_fields.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

tl::unexpected<std::string> refused(const char* why) { return tl::unexpected(std::string(why)); }

bool lies_within(double value, double least, double most) {
  return value >= least && value <= most;
}

// Of unit length, also where a square would be too large or too small for a double; not finite
// where there is no direction.
Eigen::Vector3d unit_along(const Eigen::Vector3d& direction) {
  return (direction / direction.cwiseAbs().maxCoeff()).normalized();
}

}  // namespace

tl::expected<ControlRequest, std::string> blocks_question(const control::BlocksRequest& request) {
  if (!control::MapSource_IsValid(request.source())) return refused("blocks.source is unknown");
  const int numbers = request.low_map_m_size();
  if ((numbers != 0 && numbers != 3) || request.high_map_m_size() != numbers) {
    return refused("blocks.low_map_m and high_map_m need 3 numbers each, or none");
  }
  BlocksQuestion question;
  question.source = source_of(request.source());
  if (numbers == 3) {
    const MapBox box{vector_at(request.low_map_m(), 0), vector_at(request.high_map_m(), 0)};
    if (!box.low.allFinite() || !box.high.allFinite() ||
        (box.low.array() > box.high.array()).any()) {
      return refused("blocks.low_map_m must be below high_map_m, both finite");
    }
    question.box = box;
  }
  if (!lies_within(request.wait_s(), 0.0, BlocksQuestion::kWaitMost_s)) {
    return refused("blocks.wait_s is 0 to 60");
  }
  question.wait_s = request.wait_s();
  if (request.has_rate_hz()) question.rate_hz = request.rate_hz();
  if (!lies_within(question.rate_hz, BlocksQuestion::kRateLeast_hz, BlocksQuestion::kRateMost_hz)) {
    return refused("blocks.rate_hz is 0.1 to 10");
  }
  if (request.most_bytes() != 0) question.most_bytes = request.most_bytes();
  if (question.most_bytes < BlocksQuestion::kBytesMin ||
      question.most_bytes > BlocksQuestion::kBytesMax) {
    return refused("blocks.most_bytes is 4096 to 1048576, or 0");
  }
  if (request.cursor().empty()) return question;
  question.cursor = decode_cursor(request.cursor());
  if (!question.cursor) return refused("blocks.cursor is none that an answer had");
  if (question.cursor->scope != question.scope()) {
    return refused("blocks.cursor is of another source or box: ask without it");
  }
  return question;
}

tl::expected<ControlRequest, std::string> rays_question(const control::RaysRequest& request) {
  if (!control::MapSource_IsValid(request.source())) return refused("rays.source is unknown");
  const int numbers = request.directions_map_size();
  const int origins = request.origins_map_m_size();
  if (numbers == 0 || numbers % 3 != 0 || (origins != 3 && origins != numbers)) {
    return refused("rays.directions_map needs 3 numbers a ray, origins_map_m as many, or 3");
  }
  if (numbers / 3 > static_cast<int>(RaysQuestion::kRaysMax)) {
    return refused("rays.directions_map has more than 1024 rays");
  }
  if (!(std::isfinite(request.max_range_m()) && request.max_range_m() > 0.0)) {
    return refused("rays.max_range_m must be above 0");
  }
  RaysQuestion question{
      source_of(request.source()), {}, request.max_range_m(), request.through_unknown()};
  for (int first = 0; first < numbers; first += 3) {
    const MapRay ray{vector_at(request.origins_map_m(), origins == 3 ? 0 : first),
                     unit_along(vector_at(request.directions_map(), first))};
    if (!ray.origin_map.allFinite() || !ray.direction_map.allFinite()) {
      return refused("rays.origins_map_m must be finite, directions_map finite and not zero");
    }
    question.rays.push_back(ray);
  }
  return question;
}

}  // namespace warren
