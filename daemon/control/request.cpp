// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/request.hpp"

#include <algorithm>

#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::size_t kMaxPathBytes = 4095;  // PATH_MAX less the terminating zero

tl::expected<ControlRequest, std::string> save_order(const control::MapSaveRequest& request) {
  const std::string& path = request.path();
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  if (path.empty() || path.front() != '/') {
    return tl::unexpected(std::string("map_save.path must be absolute"));
  }
  if (path.size() > kMaxPathBytes) return tl::unexpected(std::string("map_save.path is too long"));
  if (std::any_of(path.begin(), path.end(), is_control)) {
    return tl::unexpected(std::string("map_save.path has control characters"));
  }
  if (!control::PictureColours_IsValid(request.colours())) {
    return tl::unexpected(std::string("map_save.colours is unknown"));
  }
  return SaveOrder{
      path, request.colours() == control::COST ? PictureColours::kCost : PictureColours::kHeight};
}

using Doubles = google::protobuf::RepeatedField<double>;

Eigen::Vector3d vector_at(const Doubles& field, int first) {
  return {field[first], field[first + 1], field[first + 2]};
}

tl::expected<ControlRequest, std::string> ground_question(const control::GroundRequest& request) {
  if (request.t_map_base_size() != 7) {
    return tl::unexpected(std::string("ground.t_map_base needs 7 numbers: x y z qx qy qz qw"));
  }
  if (request.gravity_map_size() != 0 && request.gravity_map_size() != 3) {
    return tl::unexpected(std::string("ground.gravity_map needs 3 numbers, or none"));
  }
  const Doubles& pose = request.t_map_base();
  GroundQuestion question;
  question.T_map_base.translation = vector_at(pose, 0);
  question.T_map_base.rotation = Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]);
  question.footprint = {request.length_m(), request.width_m()};
  question.stair_capable = request.stair_capable();
  if (request.has_above_m()) question.above_m = request.above_m();
  if (request.has_below_m()) question.below_m = request.below_m();
  if (request.gravity_map_size() == 3) question.gravity_map = vector_at(request.gravity_map(), 0);
  return question;
}

tl::expected<ControlRequest, std::string> layer_diff_question(
    const control::LayerDiffRequest& request) {
  if (request.first_key() >= kOrdinalEnd) {
    return tl::unexpected(std::string("layer_diff.first_key is past the last key"));
  }
  return LayerDiffQuestion{{request.first_key(), kOrdinalEnd}, Revision{request.from()}};
}

}  // namespace

tl::expected<ControlRequest, std::string> decode_control_request(std::span<const std::byte> bytes) {
  control::Request request;
  if (bytes.size() > kMaxControlFrameBytes ||
      !request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return tl::unexpected(std::string("this is no control Request"));
  }
  switch (request.body_case()) {
    case control::Request::kStatus:
      return StatusQuestion{};
    case control::Request::kMapInfo:
      return MapInfoQuestion{};
    case control::Request::kConfigPrint:
      return ConfigQuestion{};
    case control::Request::kMapSave:
      return save_order(request.map_save());
    case control::Request::kLayerDiff:
      return layer_diff_question(request.layer_diff());
    case control::Request::kGround:
      return ground_question(request.ground());
    default:
      return tl::unexpected(std::string("the request has no known body"));
  }
}

}  // namespace warren
