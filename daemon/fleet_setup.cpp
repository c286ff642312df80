// SPDX-License-Identifier: Apache-2.0
#include "daemon/fleet_setup.hpp"

#include <chrono>

#include "daemon/fleet/node_id.hpp"
#include "daemon/key_file.hpp"
#include "daemon/random_bits.hpp"

namespace warren {
namespace {

constexpr std::size_t kHeaderBytesIpv4 = 28;  // IP and UDP
constexpr std::size_t kHeaderBytesIpv6 = 48;

template <typename Time>
Time time_of(double seconds) {
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
}

mesh::InterfaceConfig endpoint_interface(const MeshInterfaceConfig& interface) {
  mesh::InterfaceConfig config;
  config.mtu_bytes = interface.mtu_bytes;
  config.ip_header_bytes = interface.ipv6 ? kHeaderBytesIpv6 : kHeaderBytesIpv4;
  if (interface.ceiling_kbit_s) config.ceiling_bit_s = *interface.ceiling_kbit_s * 1e3;
  config.group_broadcast = interface.group_packets;
  config.seeds = interface.seeds;
  return config;
}

mesh::MeshRunner::Config runner_config(const MeshSettings& mesh, MemberId self) {
  mesh::MeshRunner::Config config;
  config.endpoint.self = self;
  config.endpoint.boot = {random_bits()};
  config.endpoint.random_seed = random_bits();
  config.sockets.port = static_cast<std::uint16_t>(mesh.port);
  config.sockets.group_port = static_cast<std::uint16_t>(mesh.group_port);
  config.sockets.group_loop = mesh.group_loop;
  for (const MeshInterfaceConfig& interface : mesh.interfaces) {
    config.endpoint.interfaces.push_back(endpoint_interface(interface));
    config.sockets.interfaces.push_back(
        {interface.name, interface.ipv4, interface.ipv6, interface.broadcast});
  }
  return config;
}

replication::SharePolicy share_policy(const ShareSettings& share) {
  switch (share.policy) {
    case SharePolicyChoice::kNear:
      return {replication::Share::kNear, share.radius_m};
    case SharePolicyChoice::kNothing:
      return {replication::Share::kNothing, share.radius_m};
    case SharePolicyChoice::kEverything:
      break;
  }
  return {replication::Share::kEverything, share.radius_m};
}

}  // namespace

tl::expected<FleetConfig, std::string> fleet_config_of(const Config& config) {
  const std::uint32_t origin = node_id(config.node.name);
  FleetConfig fleet;
  // The config allows no resolution that a layer cannot have.
  fleet.map = {origin, Resolution::from_metres(config.map.resolution_m).value(),
               config.layer.resolved(), config.layer.rest_after_ticks()};
  fleet.tick = time_of<std::chrono::nanoseconds>(config.layer.tick_s);
  fleet.shutdown = time_of<Duration>(config.mesh.shutdown_s);
  FleetMeshConfig& mesh = fleet.mesh;
  mesh.tick = time_of<Duration>(config.layer.tick_s);
  if (config.mesh.is_on()) {
    const auto key = read_key_file(config.mesh.key_file);
    if (!key) return tl::unexpected(key.error());
    mesh.runner = runner_config(config.mesh, MemberId{origin});
    mesh.key = *key;
  }
  mesh.replication.self = MemberId{origin};
  mesh.replication.share = share_policy(config.share);
  mesh.replication.layers.copies_bytes_max = config.share.memory_mb_max * kBytesPerMegabyte;
  for (const MeshInterfaceConfig& interface : config.mesh.interfaces) {
    mesh.replication.group_broadcast.push_back(interface.group_packets);
  }
  mesh.log_incarnation = random_bits();
  mesh.name = config.node.name;
  mesh.role = config.node.role == Role::kBase ? NodeRole::kBase : NodeRole::kRobot;
  return fleet;
}

}  // namespace warren
