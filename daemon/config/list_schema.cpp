// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "daemon/config/schema.hpp"

namespace warren {
namespace {

constexpr Limits kCoordinate{-100.0, 100.0};

constexpr std::array kSensorKeys{
    SensorKey{"name", "The name that its scans carry.", Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.name; }},
    SensorKey{"min_range_m",
              "Points nearer to the sensor are dropped and carve nothing, metres.",
              Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.min_range_m; },
              {0.0, 100.0}},
    SensorKey{
        "max_range_m",
        "Points farther off carve free space up to here and mark nothing, metres; null: no limit.",
        Takes::kReload,
        [](SensorConfig& s) -> Slot { return &s.max_range_m; },
        {0.1, 1000.0}},
    SensorKey{"body_box.low_m",
              "The robot's own body: points in this box are dropped. Lowest corner in the base "
              "frame, metres; null: no box.",
              Takes::kReload, [](SensorConfig& s) -> Slot { return &s.body_box_low_m; },
              kCoordinate},
    SensorKey{"body_box.high_m", "Highest corner of the box.", Takes::kReload,
              [](SensorConfig& s) -> Slot { return &s.body_box_high_m; }, kCoordinate},
    SensorKey{"carve_no_returns",
              "Rays sent as no-return directions carve free space up to max_range_m.",
              Takes::kReload, [](SensorConfig& s) -> Slot { return &s.carve_no_returns; }},
};

constexpr std::array kInterfaceKeys{
    InterfaceKey{"name", "As the system calls it; it may come and go.", Takes::kRestart,
                 [](MeshInterfaceConfig& i) -> Slot { return &i.name; }},
    InterfaceKey{"ipv4", "Use IPv4 there.", Takes::kRestart,
                 [](MeshInterfaceConfig& i) -> Slot { return &i.ipv4; }},
    InterfaceKey{"ipv6", "Use IPv6 there; link-local addresses will do.", Takes::kRestart,
                 [](MeshInterfaceConfig& i) -> Slot { return &i.ipv6; }},
    InterfaceKey{"broadcast",
                 "Seek others by IPv4 broadcast as well, for radios that pass no multicast.",
                 Takes::kRestart, [](MeshInterfaceConfig& i) -> Slot { return &i.broadcast; }},
    InterfaceKey{"group_packets",
                 "Send map packets once to all who hear this interface, where several want them: "
                 "for a radio cell in which everybody hears everybody.",
                 Takes::kRestart, [](MeshInterfaceConfig& i) -> Slot { return &i.group_packets; }},
    InterfaceKey{"mtu_bytes",
                 "Largest IP packet that everybody there can take, headers included.",
                 Takes::kRestart,
                 [](MeshInterfaceConfig& i) -> Slot { return &i.mtu_bytes; },
                 {576, 9000}},
    InterfaceKey{"ceiling_kbit_s",
                 "Most that this node sends there, kbit/s, IP headers included; null: what the "
                 "links carry.",
                 Takes::kRestart,
                 [](MeshInterfaceConfig& i) -> Slot { return &i.ceiling_kbit_s; },
                 {1.0, 10e6}},
    InterfaceKey{"seeds",
                 "Nodes to seek by address, where neither multicast nor broadcast reaches them.",
                 Takes::kRestart, [](MeshInterfaceConfig& i) -> Slot { return &i.seeds; }},
};

}  // namespace

std::span<const SensorKey> sensor_keys() { return kSensorKeys; }
std::span<const InterfaceKey> interface_keys() { return kInterfaceKeys; }

}  // namespace warren
