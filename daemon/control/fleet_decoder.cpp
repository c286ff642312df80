// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/fleet_decoder.hpp"

#include <utility>

#include "daemon/control/decoded_fields.hpp"
#include "daemon/control/message_key.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::size_t kMessageBytesMax = 200'000;

using Decoded = tl::expected<ControlRequest, std::string>;

tl::unexpected<std::string> fault(std::string text) { return tl::unexpected(std::move(text)); }

Decoded send_order(const control::MessageSendRequest& request) {
  if (request.to().size() > kNodeNameBytesMax) return fault("message_send.to is too long");
  if (request.content().size() > kMessageBytesMax) {
    return fault("message_send.content has more than 200000 bytes");
  }
  if (!is_message_key(request.key())) {
    return fault("message_send.key is at most 24 of a-z A-Z 0-9 _ - . /");
  }
  if (!control::MessageClass_IsValid(request.message_class())) {
    return fault("message_send.message_class is unknown");
  }
  return MessageSendOrder{request.to(),
                          request.message_class() == control::URGENT,
                          request.key(),
                          {request.content().begin(), request.content().end()}};
}

FleetOrder::What what_of(control::FleetOrderRequest::What what) {
  switch (what) {
    case control::FleetOrderRequest::RESTORE:
      return FleetOrder::What::kRestore;
    case control::FleetOrderRequest::CLEAR:
      return FleetOrder::What::kClear;
    case control::FleetOrderRequest::ALIGN:
      return FleetOrder::What::kAlign;
    default:
      return FleetOrder::What::kRetract;
  }
}

Decoded fleet_order(const control::FleetOrderRequest& request) {
  if (!control::FleetOrderRequest_What_IsValid(request.what())) {
    return fault("fleet_order.what is unknown");
  }
  FleetOrder order;
  order.what = what_of(request.what());
  order.node = request.node();
  if (request.has_layer()) {
    const control::LayerId& id = request.layer();
    order.layer = LayerId{id.origin(), id.number(), id.incarnation()};
  }
  const bool clears = order.what == FleetOrder::What::kClear;
  if (order.layer ? !order.node.empty() || clears : order.node.empty()) {
    return fault("fleet_order needs a node, or a layer to retract, restore or align");
  }
  order.shift = {{request.x_m(), request.y_m(), request.z_m()}, request.yaw_rad()};
  if (!order.shift.is_within_reach())
    return fault("fleet_order needs up to 1e8 m each way and 1000 rad");
  return order;
}

Decoded estimate_question(const control::AlignEstimateRequest& request) {
  if (request.node().empty()) return fault("align_estimate.node is needed");
  if (request.node() == request.against()) {
    return fault("align_estimate.against must be another node");
  }
  return AlignEstimateQuestion{request.node(), request.against()};
}

Decoded trajectory_question(const control::TrajectoryRequest& request) {
  if (request.node().empty()) return fault("trajectory.node is needed");
  return TrajectoryQuestion{request.node(), request.after_us()};
}

}  // namespace

Decoded decode_fleet_request(const control::Request& request) {
  switch (request.body_case()) {
    case control::Request::kMessageSend:
      return send_order(request.message_send());
    case control::Request::kMessageWatch:
      return MessageWatchQuestion{request.message_watch().inbox(), request.message_watch().after()};
    case control::Request::kFleetOrder:
      return fleet_order(request.fleet_order());
    case control::Request::kTrajectory:
      return trajectory_question(request.trajectory());
    case control::Request::kAlignEstimate:
      return estimate_question(request.align_estimate());
    default:
      return fault("the request has no known body");
  }
}

}  // namespace warren
