// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/schema.hpp"

#include <array>

namespace warren {
namespace {

using namespace std::string_view_literals;

constexpr std::array kRoles{"robot"sv};
constexpr std::array kPresets{"octomap"sv, "field"sv, "custom"sv};
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
constexpr Limits kCoordinate{-100.0, 100.0};

constexpr std::array kRootKeys{
    RootKey{"node.name", "Name of this node in logs and status.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.node.name; }},
    RootKey{"node.role",
            "What this node is.",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.node.role); },
            {},
            kRoles},
    RootKey{"sockets.ingest.path", "Unix socket that takes scans.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.ingest.path; }},
    RootKey{"sockets.ingest.mode", "Who may connect: permission bits, octal.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.ingest.mode; }},
    RootKey{"sockets.control.path", "Unix socket of warrenctl.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.control.path; }},
    RootKey{"sockets.control.mode", "Who may connect: permission bits, octal.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.sockets.control.mode; }},
    RootKey{"map.resolution_m",
            "Edge of a voxel.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.map.resolution_m; },
            {0.01, 1.0}},
    RootKey{"map.sensor_model.preset",
            "Which probabilities: OctoMap's, the field's, or your own.",
            Takes::kRestart,
            [](Config& c) -> Slot { return choice(c.map.sensor_model.preset); },
            {},
            kPresets},
    RootKey{"map.sensor_model.hit", "Custom: occupancy after a ray ended in an unseen voxel.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.hit; },
            kSpeaksForOccupied},
    RootKey{"map.sensor_model.miss", "Custom: occupancy after a ray passed an unseen voxel.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.sensor_model.miss; },
            kSpeaksForFree},
    RootKey{"map.sensor_model.minimum", "Custom: occupancy never falls below.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.map.sensor_model.minimum; }, kSpeaksForFree},
    RootKey{"map.sensor_model.maximum", "Custom: occupancy never rises above.", Takes::kRestart,
            [](Config& c) -> Slot { return &c.map.sensor_model.maximum; }, kSpeaksForOccupied},
    RootKey{"map.one_ray_per_end_voxel", "Cast one ray per end voxel: faster, slightly coarser.",
            Takes::kRestart, [](Config& c) -> Slot { return &c.map.one_ray_per_end_voxel; }},
    RootKey{"ingest.queue_scans",
            "Scans that may wait for the map; then the oldest is dropped.",
            Takes::kReload,
            [](Config& c) -> Slot { return &c.ingest.queue_scans; },
            {1, 1024}},
    RootKey{"ingest.max_points",
            "Points and no-return directions of one scan, together.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.max_points; },
            {1, 4194304}},
    RootKey{"ingest.max_clients",
            "Clients connected at a time.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.max_clients; },
            {1, 256}},
    RootKey{"ingest.message_timeout_s",
            "A message begun must be whole within this time.",
            Takes::kRestart,
            [](Config& c) -> Slot { return &c.ingest.message_timeout_s; },
            {0.05, 3600}},
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

constexpr std::array kSensorKeys{
    SensorKey{"name", "What its scans call it.", Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.name; }},
    SensorKey{"min_range_m",
              "Nearer points are dropped and carve nothing.",
              Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.min_range_m; },
              {0.0, 100.0}},
    SensorKey{"max_range_m",
              "Farther points carve up to here and mark nothing; null: no limit.",
              Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.max_range_m; },
              {0.1, 1000.0}},
    SensorKey{"body_box.low_m",
              "Robot's body in the base frame, lowest corner x, y, z; null: none.", Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.body_box_low_m; }, kCoordinate},
    SensorKey{"body_box.high_m", "Its highest corner; points in the box are dropped.",
              Takes::kReload, [](SensorConfig& s) -> Slot { return &s.body_box_high_m; },
              kCoordinate},
    SensorKey{"carve_no_returns", "Rays that came back with nothing carve up to max_range_m.",
              Takes::kReload, [](SensorConfig& s) -> Slot { return &s.carve_no_returns; }},
};

}  // namespace

std::span<const RootKey> root_keys() { return kRootKeys; }
std::span<const SensorKey> sensor_keys() { return kSensorKeys; }

}  // namespace warren
