// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/fleet_desk_response.hpp"

#include "daemon/control/encoded_fields.hpp"
#include "proto/framing.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

void fill(const InboxMessage& held, const std::string& from, control::ReceivedMessage& message) {
  message.set_number(held.number);
  message.set_from(from);
  message.set_to_all(!held.message.to);
  message.set_message_class(held.message.urgent ? control::URGENT : control::NORMAL);
  message.set_key(held.message.key);
  message.set_time_us(held.message.time_us);
  message.set_content(std::string(held.message.bytes.begin(), held.message.bytes.end()));
}

}  // namespace

std::string encode_message_accepted(std::uint32_t number) {
  control::Response response;
  response.mutable_message_accepted()->set_number(number);
  return framed(response.SerializeAsString());
}

std::string encode_messages(const InboxReport& report) {
  control::Response response;
  auto& messages = *response.mutable_messages();
  messages.set_inbox(report.excerpt.inbox);
  messages.set_next(report.excerpt.next);
  for (std::size_t i = 0; i < report.excerpt.messages.size(); ++i) {
    fill(report.excerpt.messages[i], report.senders[i], *messages.add_messages());
  }
  messages.set_missed(report.excerpt.missed);
  messages.set_more(report.excerpt.more);
  messages.set_dropped(report.dropped);
  return framed(response.SerializeAsString());
}

std::string encode_fleet_ordered(const std::vector<LayerId>& layers) {
  control::Response response;
  auto& ordered = *response.mutable_fleet_ordered();
  for (const LayerId& layer : layers) fill(layer, *ordered.add_layers());
  return framed(response.SerializeAsString());
}

std::string encode_trajectory(const std::string& node, const FleetPath& path) {
  control::Response response;
  auto& trajectory = *response.mutable_trajectory();
  trajectory.set_node(node);
  for (const FleetPath::Point& point : path.points) {
    auto& message = *trajectory.add_points();
    message.set_time_us(point.time_us);
    message.set_x_m(point.position_fleet.x());
    message.set_y_m(point.position_fleet.y());
    message.set_z_m(point.position_fleet.z());
    message.set_layer(point.layer.number);
  }
  trajectory.set_unplaced(path.unplaced);
  trajectory.set_more(path.more);
  return framed(response.SerializeAsString());
}

std::string encode_align_estimate(const LayerId& layer, const LayerId& against,
                                  const RegistrationResult& result) {
  control::Response response;
  auto& estimate = *response.mutable_align_estimate();
  fill(layer, *estimate.mutable_layer());
  fill(against, *estimate.mutable_against());
  estimate.set_x_m(result.shift_m.x());
  estimate.set_y_m(result.shift_m.y());
  estimate.set_z_m(result.shift_m.z());
  estimate.set_yaw_rad(result.yaw_rad);
  estimate.set_voxels(result.voxels);
  estimate.set_fit_before(result.fit_before);
  estimate.set_fit(result.fit);
  estimate.set_rms_m(result.rms_m);
  estimate.set_trusted(result.is_trusted());
  return framed(response.SerializeAsString());
}

}  // namespace warren
