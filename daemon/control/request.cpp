// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/request.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/control/decoded_fields.hpp"
#include "daemon/control/fleet_decoder.hpp"
#include "daemon/control/planner_request.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::uint32_t kVoxelDepth = 16;
constexpr std::size_t kMaxPathBytes = 4095;  // PATH_MAX less the terminating zero

// What is wrong with the path that this request names; nothing if nothing is.
std::optional<std::string> fault_of_path(const std::string& request, const std::string& path) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  if (path.empty() || path.front() != '/') return request + ".path must be absolute";
  if (path.size() > kMaxPathBytes) return request + ".path is too long";
  if (std::any_of(path.begin(), path.end(), is_control)) {
    return request + ".path has control characters";
  }
  return std::nullopt;
}

PictureColours colours_of(control::PictureColours colours) {
  if (colours == control::COST) return PictureColours::kCost;
  return colours == control::ROBOT ? PictureColours::kSource : PictureColours::kHeight;
}

tl::expected<ControlRequest, std::string> save_order(const control::MapSaveRequest& request) {
  if (auto fault = fault_of_path("map_save", request.path())) {
    return tl::unexpected(*std::move(fault));
  }
  if (!control::PictureColours_IsValid(request.colours())) {
    return tl::unexpected(std::string("map_save.colours is unknown"));
  }
  if (!control::MapSource_IsValid(request.source())) {
    return tl::unexpected(std::string("map_save.source is unknown"));
  }
  const MapSource source = source_of(request.source());
  if (!request.of().empty() && source == MapSource::kMerge) {
    return tl::unexpected(std::string("map_save.of is of source SELF alone"));
  }
  if (request.of().size() > kNodeNameBytesMax) {
    return tl::unexpected(std::string("map_save.of is too long"));
  }
  if (request.colours() == control::ROBOT && source == MapSource::kSelf) {
    return tl::unexpected(std::string("map_save.colours ROBOT is of source MERGE alone"));
  }
  return SaveOrder{request.path(), colours_of(request.colours()), source, request.of()};
}

tl::expected<ControlRequest, std::string> load_order(const control::MapLoadRequest& request) {
  if (auto fault = fault_of_path("map_load", request.path())) {
    return tl::unexpected(*std::move(fault));
  }
  return LoadOrder{request.path()};
}

tl::expected<ControlRequest, std::string> ground_question(const control::GroundRequest& request) {
  if (request.t_map_base_size() != 7) {
    return tl::unexpected(std::string("ground.t_map_base needs 7 numbers: x y z qx qy qz qw"));
  }
  if (request.gravity_map_size() != 0 && request.gravity_map_size() != 3) {
    return tl::unexpected(std::string("ground.gravity_map needs 3 numbers, or none"));
  }
  if (!control::MapSource_IsValid(request.source())) {
    return tl::unexpected(std::string("ground.source is unknown"));
  }
  if (!(request.unknown_up_to() >= 0.0 && request.unknown_up_to() <= 1.0)) {
    return tl::unexpected(std::string("ground.unknown_up_to is 0 to 1"));
  }
  const Doubles& pose = request.t_map_base();
  GroundQuestion question;
  question.source = source_of(request.source());
  question.T_map_base.translation = vector_at(pose, 0);
  question.T_map_base.rotation = Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]);
  question.footprint = {request.length_m(), request.width_m()};
  question.stair_capable = request.stair_capable();
  question.unknown_up_to = request.unknown_up_to();
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

tl::expected<ControlRequest, std::string> cells_question(const control::CellsRequest& request) {
  const bool is_point = request.high_map_m_size() == 0;
  if (request.low_map_m_size() != 3 || (!is_point && request.high_map_m_size() != 3)) {
    return tl::unexpected(std::string("cells.low_map_m needs 3 numbers, high_map_m 3 or none"));
  }
  if (!control::MapSource_IsValid(request.source())) {
    return tl::unexpected(std::string("cells.source is unknown"));
  }
  const bool by_edge = request.size_case() == control::CellsRequest::kCellM;
  const bool by_depth = request.size_case() == control::CellsRequest::kDepth;
  if (by_depth && request.depth() > kVoxelDepth) {
    return tl::unexpected(std::string("cells.depth is 0 to 16"));
  }
  if (by_edge && !(std::isfinite(request.cell_m()) && request.cell_m() > 0.0)) {
    return tl::unexpected(std::string("cells.cell_m must be above 0"));
  }
  CellsQuestion question;
  question.source = source_of(request.source());
  question.low_map = vector_at(request.low_map_m(), 0);
  question.high_map = is_point ? question.low_map : vector_at(request.high_map_m(), 0);
  if (!question.low_map.allFinite() || !question.high_map.allFinite() ||
      (question.low_map.array() > question.high_map.array()).any()) {
    return tl::unexpected(std::string("cells.low_map_m must be below high_map_m, both finite"));
  }
  question.size = by_depth ? request.depth() : kVoxelDepth;
  if (by_edge) question.size = request.cell_m();
  return question;
}

LayerId id_of(const control::LayerId& id) { return {id.origin(), id.number(), id.incarnation()}; }

template <typename Order, typename Request>
tl::expected<ControlRequest, std::string> layer_order(const std::string& name,
                                                      const Request& request) {
  if (!request.has_layer()) return tl::unexpected(name + ".layer is needed");
  return Order{id_of(request.layer())};
}

tl::expected<ControlRequest, std::string> move_order(const control::MapMoveRequest& request) {
  if (!request.has_layer()) return tl::unexpected(std::string("map_move.layer is needed"));
  const MoveOrder order{id_of(request.layer()),
                        {{request.x_m(), request.y_m(), request.z_m()}, request.yaw_rad()}};
  if (!order.shift.is_within_reach()) {
    return tl::unexpected(std::string("map_move needs up to 1e8 m each way and 1000 rad"));
  }
  return order;
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
    case control::Request::kMapLoad:
      return load_order(request.map_load());
    case control::Request::kLayerFlush:
      return FlushOrder{};
    case control::Request::kMapRetract:
      return layer_order<RetractOrder>("map_retract", request.map_retract());
    case control::Request::kMapRestore:
      return layer_order<RestoreOrder>("map_restore", request.map_restore());
    case control::Request::kMapMove:
      return move_order(request.map_move());
    case control::Request::kCells:
      return cells_question(request.cells());
    case control::Request::kFleetStatus:
      return FleetStatusQuestion{};
    case control::Request::kGround:
      return ground_question(request.ground());
    case control::Request::kMessageSend:
    case control::Request::kMessageWatch:
    case control::Request::kFleetOrder:
    case control::Request::kTrajectory:
    case control::Request::kAlignEstimate:
      return decode_fleet_request(request);
    case control::Request::kBlocks:
      return blocks_question(request.blocks());
    case control::Request::kRays:
      return rays_question(request.rays());
    default:
      return tl::unexpected(std::string("the request has no known body"));
  }
}

}  // namespace warren
