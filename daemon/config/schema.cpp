// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/schema.hpp"

#include <array>

namespace warren {
namespace {

using namespace std::string_view_literals;

constexpr std::array kRoles{"robot"sv, "base"sv};
constexpr std::array kSharePolicies{"everything"sv, "near"sv, "nothing"sv};
constexpr std::array kPresets{"warren"sv, "octomap"sv, "field"sv, "custom"sv};
constexpr std::array kTerrainProfiles{"robust"sv, "paper"sv};
constexpr std::array kCostRules{"information"sv, "paper"sv};
constexpr std::array kLogLevels{"debug"sv, "info"sv, "warning"sv, "error"sv, "off"sv};
constexpr std::array kLogFormats{"auto"sv, "text"sv, "journal"sv};

// unsigned char may alias an enumeration over it.
template <typename Enum>
ChoiceSlot choice(Enum& value) {
  static_assert(sizeof(Enum) == 1);
  return {reinterpret_cast<unsigned char*>(&value)};
}

// Below one half a probability speaks for free, above for occupied; 0 and 1 have no log-odds.
constexpr Limits kSpeaksForFree{0.001, 0.499};
constexpr Limits kSpeaksForOccupied{0.501, 0.999};
constexpr Limits kSurveyed{-1e6, 1e6};
constexpr Limits kPorts{0, 65535};
// Below, there is no room for the write-ahead log.
constexpr Limits kDiskMb{256, 1e6};

constexpr std::array kRootKeys{
    RootKey{"node.name", "Name of this node, in logs and status.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.node.name; }},
    RootKey{
        "node.role",
        "What this node is. robot: maps what its own sensors see; base: has no sensors, and opens "
        "no ingest socket.",
        Takes::kRestart,
        [](Config& c) -> Slot { return choice(c.node.role); },
        {},
        kRoles},
    RootKey{"node.fleet_T_map.x_m",
            "Where the map frame's origin lies in the fleet frame at the start, as surveyed, "
            "metres. A pose update replaces it.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.node.fleet_T_map.x_m; }, kSurveyed},
    RootKey{"node.fleet_T_map.y_m", "The same along y.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.node.fleet_T_map.y_m; }, kSurveyed},
    RootKey{"node.fleet_T_map.z_m", "The same along z.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.node.fleet_T_map.z_m; }, kSurveyed},
    RootKey{"node.fleet_T_map.yaw_deg",
            "How far the map frame is turned about the vertical, degrees.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.node.fleet_T_map.yaw_deg; },
            {-360.0, 360.0}},
    RootKey{"sockets.ingest.path", "Unix socket that takes scans (docs/PROTOCOL.md).",
            Takes::kRestart, [](Config& c) -> Slot { return &c.sockets.ingest.path; }},
    RootKey{"sockets.ingest.mode", "Who may connect: permission bits, octal.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.ingest.mode; }},
    RootKey{"sockets.control.path", "Unix socket that answers warrenctl.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.control.path; }},
    RootKey{"sockets.control.mode", "Who may connect: permission bits, octal.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.control.mode; }},
    RootKey{"map.resolution_m",
            "Edge of a voxel, metres. Half of it means about four times the voxels in view.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.map.resolution_m; },
            {0.01, 1.0}},
    RootKey{
        "map.sensor_model.preset",
        "Probabilities of a hit and a pass, and their clamps. warren: 0.97 0.47 0.12 0.97, keeps "
        "thin things, and a person who has left is gone after 29 scans; octomap: OctoMap's "
        "defaults, gone after 9, but thin things too; field: keeps thin things longest, gone "
        "after 44; custom: the four numbers below.",
        Takes::kRestart,
        [](Config& c) -> Slot { return choice(c.map.sensor_model.preset); },
        {},
        kPresets},
    RootKey{"map.sensor_model.hit",
            "Custom only: probability that a voxel is occupied, given that a ray ended in it.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.hit; },
            kSpeaksForOccupied},
    RootKey{"map.sensor_model.miss", "Custom only: the same, given that a ray passed through it.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.miss; },
            kSpeaksForFree},
    RootKey{"map.sensor_model.minimum", "Custom only: no voxel's probability falls below this.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.minimum; },
            kSpeaksForFree},
    RootKey{"map.sensor_model.maximum", "Custom only: no voxel's probability rises above this.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.maximum; },
            kSpeaksForOccupied},
    RootKey{"map.one_ray_per_end_voxel",
            "Cast one ray per end voxel, to its centre: faster, but not quite the same map.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.one_ray_per_end_voxel; }},
    RootKey{"terrain.profile",
            "How the cost of ground is told. robust: slope, curvature, roughness and steps, no "
            "data where a plane cannot be trusted; paper: slope and curvature alone.",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.terrain.profile); },
            {},
            kTerrainProfiles},
    RootKey{"terrain.saturation",
            "Sum of slope and curvature terms that counts as impossible; 1 suits short-range depth "
            "cameras.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.terrain.saturation; },
            {0.05, 10.0}},
    RootKey{"terrain.step_harmless_m",
            "Steps up to this height cost nothing (robust). Raise it for robots that climb.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.terrain.step_harmless_m; },
            {0.0, 2.0}},
    RootKey{"terrain.step_critical_m",
            "Steps from this height on are impossible (robust); above step_harmless_m.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.terrain.step_critical_m; },
            {0.01, 3.0}},
    RootKey{"terrain.fusion",
            "How a voxel's costs of many scans become one. information: average weighted by how "
            "much each scan can tell, follows changes; paper: the surer the voxel is occupied, "
            "the less a new cost counts.",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.terrain.fusion); },
            {},
            kCostRules},
    RootKey{"layer.tick_s",
            "How often what changed in the map is published to others, seconds.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.layer.tick_s; },
            {0.1, 60.0}},
    RootKey{"layer.hold_ragged_free",
            "A voxel newly seen free is published once its 2x2x2 cube is known: about half the "
            "bytes, and a few of a hundred free voxels come later. Obstacles never wait.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.layer.hold_ragged_free; }},
    RootKey{"layer.hold_small_cost_changes",
            "A cost that moved by one of its 15 bins, and across no threshold of planners, is not "
            "published anew.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.layer.hold_small_cost_changes; }},
    RootKey{"layer.flush_after_s",
            "What the two rules above hold back is published after so long without a change, "
            "seconds; and at shutdown.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.layer.flush_after_s; },
            {0.1, 3600.0}},
    RootKey{"layer.packet_bytes",
            "Largest diff packet. Small ones suit bad radios, and cost a few per cent more.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.layer.packet_bytes; },
            {440, 1400}},
    RootKey{"layer.rest_after_s",
            "Parts of a layer that nothing has changed for so long, seconds, are packed: about a "
            "thirtieth of the memory, and some milliseconds whenever one is read or changed again.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.layer.rest_after_s; },
            {0.1, 86400.0}},
    RootKey{"ingest.queue_scans",
            "Scans that may wait for the mapping thread. When one more comes, the oldest is "
            "dropped and counted.",
            Takes::kReload,
            [](Config& c) -> Slot { return &c.ingest.queue_scans; },
            {1, 1024}},
    RootKey{"ingest.max_points",
            "Points and no-return directions that one scan may have, together. Bounds memory: at "
            "most queue_scans + max_clients scans are held, at 12 bytes each point.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.max_points; },
            {1, 4194304}},
    RootKey{"ingest.max_clients",
            "Clients that may be connected at a time.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.max_clients; },
            {1, 256}},
    RootKey{"ingest.message_timeout_s",
            "A client whose message, once begun, is not whole within this time is closed.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.message_timeout_s; },
            {0.05, 3600}},
    RootKey{"mesh.key_file",
            "The secret that all members of the fleet share, for this user's eyes only: "
            "warrenctl key new FILE. Unused while no interface is named.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.mesh.key_file; }},
    RootKey{"mesh.port",
            "UDP port of this node; 0: any that is free. Nodes on one host need different ones.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.mesh.port; }, kPorts},
    RootKey{"mesh.group_port",
            "UDP port on which the whole fleet finds each other.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.mesh.group_port; },
            {1, 65535}},
    RootKey{"mesh.group_loop", "Other nodes on this host hear what goes to the whole fleet, too.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.mesh.group_loop; }},
    RootKey{"mesh.shutdown_s",
            "At shutdown, what neighbours have not got yet is sent for at most so long, seconds. "
            "The store is waited for in any case, for up to 5 s.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.mesh.shutdown_s; },
            {0.0, 600.0}},
    RootKey{"share.policy",
            "Which layers of others are copied here. everything: all of them, also for those who "
            "cannot hear each other; near: what lies within radius_m of this node; nothing: where "
            "others are, but not what they mapped. A base holds everything.",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.share.policy); },
            {},
            kSharePolicies},
    RootKey{"share.radius_m",
            "With policy near: how far from this node, metres.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.share.radius_m; },
            {1.0, 10000.0}},
    RootKey{
        "share.memory_mb_max",
        "Most that copies of others' layers take in memory, megabytes of 10^6 bytes. At it, they "
        "grow no more until some have been packed; this node's own map is never held back.",
        Takes::kRestart,
        [](Config& c) -> Slot { return &c.share.memory_mb_max; },
        {1.0, 1e6}},
    RootKey{"store.enabled",
            "Keep map, copies and messages in a file, and go on with them after a restart. false: "
            "a restart begins anew.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.store.enabled; }},
    RootKey{"store.file", "The file, in a folder that exists; others beside it begin as its name.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.store.file; }},
    RootKey{
        "store.disk_mb_max",
        "Most that the store takes on the disk, megabytes of 10^6 bytes. Near it, messages and "
        "maps of others go; this node's own never do: where nothing else is left, nothing new is "
        "stored or leaves this node. Two damaged files that were moved aside may lie beside it.",
        Takes::kRestart, [](Config& c) -> Slot { return &c.store.disk_mb_max; }, kDiskMb},
    RootKey{"log.level",
            "The least important lines to log.",
            Takes::kReload,
            [](Config& c) -> Slot { return choice(c.log.level); },
            {},
            kLogLevels},
    RootKey{"log.format",
            "Lines for people (text), for systemd (journal), or as stderr is (auto).",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.log.format); },
            {},
            kLogFormats},
};

}  // namespace

std::span<const RootKey> root_keys() { return kRootKeys; }

}  // namespace warren
