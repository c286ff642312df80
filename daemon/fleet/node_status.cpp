// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet/node_status.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>

#include "daemon/replication/layer_wire.hpp"

namespace warren {
namespace {

constexpr std::uint8_t kHasLayer = 1;
constexpr std::uint8_t kHasPosition = 2;
constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyz0123456789_-";

// It comes to operators' terminals and logs.
bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= NodeStatus::kNameBytesMax && name.front() != '-' &&
         name.find_first_not_of(kNameCharacters) == std::string_view::npos;
}

std::optional<std::string> read_name(mesh::PacketReader& from) {
  const auto length = from.number(NodeStatus::kNameBytesMax);
  const auto bytes = length ? from.raw(*length) : std::nullopt;
  if (!bytes) return std::nullopt;
  const std::string name(bytes->begin(), bytes->end());
  return is_name(name) ? std::optional(name) : std::nullopt;
}

std::optional<NodeStatus::Layer> read_layer(mesh::PacketReader& from) {
  const auto id = replication::read_layer_id(from);
  const auto revision = from.number(std::numeric_limits<std::uint32_t>::max());
  const auto digest = from.fixed(8);
  const auto known = from.number(std::numeric_limits<std::uint64_t>::max() / 2);
  if (!id || !revision || !digest || !known) return std::nullopt;
  return NodeStatus::Layer{*id, {static_cast<std::uint32_t>(*revision)}, *digest, *known};
}

std::optional<Eigen::Vector3f> read_position(mesh::PacketReader& from) {
  Eigen::Vector3f position;
  for (float& coordinate : position) {
    const auto bits = from.fixed(4);
    if (!bits) return std::nullopt;
    coordinate = std::bit_cast<float>(static_cast<std::uint32_t>(*bits));
  }
  return position.allFinite() ? std::optional(position) : std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> encode(const NodeStatus& status) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter to(bytes);
  to.byte(NodeStatus::kKind);
  to.byte(static_cast<std::uint8_t>(status.role));
  to.number(status.name.size());
  for (const char c : status.name) to.byte(static_cast<std::uint8_t>(c));
  to.fixed(static_cast<std::uint64_t>(status.time_us), 8);
  to.byte(static_cast<std::uint8_t>((status.layer ? kHasLayer : 0) |
                                    (status.position_fleet ? kHasPosition : 0)));
  if (status.layer) {
    replication::write(to, status.layer->id);
    to.number(status.layer->revision.number);
    to.fixed(status.layer->digest, 8);
    to.number(status.layer->known_voxels);
  }
  if (status.position_fleet) {
    for (const float coordinate : *status.position_fleet) {
      to.fixed(std::bit_cast<std::uint32_t>(coordinate), 4);
    }
  }
  return bytes;
}

std::optional<NodeStatus> read_node_status(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader from(bytes);
  if (from.fixed(1) != NodeStatus::kKind) return std::nullopt;
  NodeStatus status;
  const auto role = from.fixed(1);
  if (!role || *role > static_cast<std::uint64_t>(NodeRole::kBase)) return std::nullopt;
  status.role = static_cast<NodeRole>(*role);
  const auto name = read_name(from);
  const auto time = from.fixed(8);
  const auto flags = from.fixed(1);
  if (!name || !time || !flags || *flags > (kHasLayer | kHasPosition)) return std::nullopt;
  status.name = *name;
  status.time_us = static_cast<std::int64_t>(*time);
  if ((*flags & kHasLayer) != 0) {
    status.layer = read_layer(from);
    if (!status.layer) return std::nullopt;
  }
  if ((*flags & kHasPosition) != 0) {
    status.position_fleet = read_position(from);
    if (!status.position_fleet) return std::nullopt;
  }
  return from.at_end() ? std::optional(std::move(status)) : std::nullopt;
}

}  // namespace warren
