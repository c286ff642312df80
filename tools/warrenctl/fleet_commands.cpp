// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/fleet_commands.hpp"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <numbers>
#include <optional>
#include <sstream>

#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/failure.hpp"
#include "tools/warrenctl/loaded_layer.hpp"
#include "tools/warrenctl/message_watch.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr double kRadian = 180.0 / std::numbers::pi;  // in degrees
constexpr double kMicro = 1e-6;

tl::expected<std::string, std::string> content_of(const MessageSendCommand& command) {
  if (command.file.empty()) return command.text;
  std::ifstream file(command.file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file) return tl::unexpected("cannot read " + command.file.string());
  return content;
}

int run_one(const MessageSendCommand& command, const std::string& socket) {
  auto content = content_of(command);
  if (!content) return failure(content.error());
  control::Request request;
  auto& send = *request.mutable_message_send();
  send.set_to(command.to);
  send.set_message_class(command.urgent ? control::URGENT : control::NORMAL);
  send.set_key(command.key);
  send.set_content(std::move(*content));
  const auto response = ask_daemon(socket, request);
  if (!response) return failure(response.error());
  std::cout << "accepted as number " << response->message_accepted().number() << "\n";
  return 0;
}

int run_one(const MessageWatchCommand& command, const std::string& socket) {
  return watch_messages(command, socket);
}

tl::expected<bool, std::string> is_node(const std::string& socket, const std::string& name) {
  control::Request request;
  request.mutable_fleet_status();
  const auto response = ask_daemon(socket, request);
  if (!response) return tl::unexpected(response.error());
  const auto& nodes = response->fleet_status().nodes();
  return std::any_of(nodes.begin(), nodes.end(),
                     [&](const control::FleetNode& node) { return node.name() == name; });
}

control::FleetOrderRequest::What what_of(FleetOrderCommand::What what) {
  switch (what) {
    case FleetOrderCommand::What::kRestore:
      return control::FleetOrderRequest::RESTORE;
    case FleetOrderCommand::What::kClear:
      return control::FleetOrderRequest::CLEAR;
    case FleetOrderCommand::What::kAlign:
      return control::FleetOrderRequest::ALIGN;
    default:
      return control::FleetOrderRequest::RETRACT;
  }
}

int run_one(const FleetOrderCommand& command, const std::string& socket) {
  using What = FleetOrderCommand::What;
  control::Request request;
  auto& order = *request.mutable_fleet_order();
  order.set_what(what_of(command.what));
  const bool may_be_layer = command.what != What::kClear;
  tl::expected<bool, std::string> node = true;
  if (may_be_layer) node = is_node(socket, command.subject);
  if (!node) return failure(node.error());
  if (*node) {
    order.set_node(command.subject);
  } else {
    const auto layer = find_loaded_layer(socket, command.subject);
    if (!layer) return failure(layer.error());
    *order.mutable_layer() = *layer;
  }
  order.set_x_m(command.shift_fleet_m[0]);
  order.set_y_m(command.shift_fleet_m[1]);
  order.set_z_m(command.shift_fleet_m[2]);
  order.set_yaw_rad(command.yaw_deg / kRadian);
  const auto response = ask_daemon(socket, request);
  if (!response) return failure(response.error());
  const auto& layers = response->fleet_ordered().layers();
  std::cout << "ordered for the whole fleet; about " << layers.size()
            << (layers.size() == 1 ? " layer" : " layers") << " as far as known here:";
  for (const control::LayerId& layer : layers) std::cout << " " << text_of(layer);
  std::cout << "\n";
  return 0;
}

// By its id: the node may have begun another layer by then.
std::string command_of(const control::AlignEstimate& estimate) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(3) << "warrenctl align " << text_of(estimate.layer())
      << " " << estimate.x_m() << " " << estimate.y_m() << " " << estimate.z_m() << " "
      << std::setprecision(2) << estimate.yaw_rad() * kRadian;
  return out.str();
}

int run_one(const AlignEstimateCommand& command, const std::string& socket) {
  control::Request request;
  request.mutable_align_estimate()->set_node(command.node);
  request.mutable_align_estimate()->set_against(command.against);
  const auto response = ask_daemon(socket, request);
  if (!response) return failure(response.error());
  const control::AlignEstimate& estimate = response->align_estimate();
  if (command.json) {
    std::cout << json_of(estimate);
    return estimate.trusted() ? 0 : 1;
  }
  std::cout << std::fixed << std::setprecision(3) << "layer " << text_of(estimate.layer())
            << " against " << text_of(estimate.against()) << "\n"
            << "shift " << estimate.x_m() << " " << estimate.y_m() << " " << estimate.z_m()
            << " m, yaw " << std::setprecision(2) << estimate.yaw_rad() * kRadian << " degrees\n"
            << "of the voxels near the other's " << std::setprecision(1)
            << 100.0 * estimate.fit_before() << " % fall on them now, " << 100.0 * estimate.fit()
            << " % so placed (of " << estimate.voxels() << ", " << std::setprecision(3)
            << estimate.rms_m() << " m off)\n";
  if (!estimate.trusted()) {
    return failure("that is no good fit: the layers may not overlap, or lie too far off");
  }
  std::cout << "to order it, at a base: " << command_of(estimate) << "\n";
  return 0;
}

void print(const control::TrajectoryPoint& point, bool json) {
  std::cout << std::fixed << std::setprecision(3);
  if (json) {
    std::cout << "{\"time_s\":" << static_cast<double>(point.time_us()) * kMicro
              << ",\"x_m\":" << point.x_m() << ",\"y_m\":" << point.y_m()
              << ",\"z_m\":" << point.z_m() << ",\"layer\":" << point.layer() << "}\n";
    return;
  }
  std::cout << static_cast<double>(point.time_us()) * kMicro << " " << point.x_m() << " "
            << point.y_m() << " " << point.z_m() << " " << point.layer() << "\n";
}

int run_one(const TrajectoryCommand& command, const std::string& socket) {
  control::Request request;
  auto& question = *request.mutable_trajectory();
  question.set_node(command.node);
  std::uint64_t unplaced = 0;
  bool more = true;
  while (more) {
    const auto response = ask_daemon(socket, request);
    if (!response) return failure(response.error());
    const control::Trajectory& path = response->trajectory();
    for (const control::TrajectoryPoint& point : path.points()) print(point, command.json);
    unplaced = path.unplaced();
    more = path.more() && path.points_size() > 0;
    if (more) question.set_after_us(path.points(path.points_size() - 1).time_us());
  }
  if (unplaced > 0) {
    std::cerr << "warrenctl: " << unplaced
              << " more points lie in layers of which it is not known here where they lie\n";
  }
  return 0;
}

}  // namespace

int run(const FleetCommand& command, const std::string& socket) {
  return std::visit([&](const auto& given) { return run_one(given, socket); }, command);
}

}  // namespace warren
