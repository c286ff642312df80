// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/order.hpp"

#include <array>
#include <bit>

#include "transport/wire/packet_reader.hpp"
#include "transport/wire/packet_writer.hpp"

namespace warren {
namespace {

using replication::Item;
using replication::ItemKind;

constexpr std::uint8_t kOrderMark = 'o';

void write_subject(mesh::PacketWriter& to, const Order& order) {
  to.fixed(order.node, 4);
  to.byte(order.layer ? 1 : 0);
  if (!order.layer) return;
  to.fixed(order.layer->number, 4);
  to.fixed(order.layer->incarnation, 8);
}

bool read_subject(mesh::PacketReader& from, Order& order) {
  const auto node = from.fixed(4);
  const auto flag = node ? from.fixed(1) : std::nullopt;
  if (!flag || *flag > 1) return false;
  order.node = static_cast<std::uint32_t>(*node);
  if (*flag == 0) return true;
  const auto number = from.fixed(4);
  const auto incarnation = number ? from.fixed(8) : std::nullopt;
  if (!incarnation) return false;
  order.layer = LayerId{order.node, static_cast<std::uint32_t>(*number), *incarnation};
  return true;
}

void write_pose(mesh::PacketWriter& to, const Pose& pose) {
  const auto& t = pose.translation;
  const auto& q = pose.rotation;
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    to.fixed(std::bit_cast<std::uint64_t>(value), 8);
  }
}

std::optional<Pose> read_pose(mesh::PacketReader& from) {
  std::array<double, 7> numbers{};
  for (double& number : numbers) {
    const auto bits = from.fixed(8);
    if (!bits) return std::nullopt;
    number = std::bit_cast<double>(*bits);
  }
  Pose pose;
  pose.translation = {numbers[0], numbers[1], numbers[2]};
  pose.rotation = Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5]);
  return pose;
}

}  // namespace

Item item_of(const Order& order) {
  const bool aligns = order.verb == Order::Verb::kAlign;
  Item item;
  item.kind = ItemKind::kCommand;
  mesh::PacketWriter name(item.name);
  name.byte(kOrderMark);
  name.byte(aligns ? 1 : 0);
  write_subject(name, order);
  mesh::PacketWriter writer(item.bytes);
  writer.byte(Order::kKind);
  writer.byte(static_cast<std::uint8_t>(order.verb));
  writer.fixed(order.revision, 4);
  writer.fixed(order.writer, 4);
  write_subject(writer, order);
  if (aligns) write_pose(writer, order.correction);
  return item;
}

std::optional<Order> read_order(const Item& item) {
  if (item.kind != ItemKind::kCommand) return std::nullopt;
  mesh::PacketReader reader(item.bytes);
  if (reader.fixed(1) != Order::kKind) return std::nullopt;
  const auto verb = reader.fixed(1);
  const auto revision = verb ? reader.fixed(4) : std::nullopt;
  const auto writer = revision ? reader.fixed(4) : std::nullopt;
  if (!writer || *verb > static_cast<std::uint64_t>(Order::Verb::kAlign)) return std::nullopt;
  Order order;
  order.verb = static_cast<Order::Verb>(*verb);
  order.revision = static_cast<std::uint32_t>(*revision);
  order.writer = static_cast<std::uint32_t>(*writer);
  if (!read_subject(reader, order)) return std::nullopt;
  if (order.verb == Order::Verb::kAlign) {
    const auto correction = read_pose(reader);
    if (!correction || !order.layer) return std::nullopt;
    order.correction = *correction;
  }
  if (!reader.at_end() || item.name != item_of(order).name) return std::nullopt;
  return order;
}

}  // namespace warren
