// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/layer/publishing_config.hpp"
#include "core/terrain/terrain_judge.hpp"
#include "core/voxel/scan.hpp"
#include "core/voxel/self_map.hpp"
#include "daemon/log.hpp"
#include "transport/mesh_address.hpp"

namespace warren {

enum class Role : std::uint8_t { kRobot, kBase };
enum class SensorModelPreset : std::uint8_t { kWarren, kOctomap, kField, kCustom };

// Permission bits of a socket file.
struct FileMode {
  std::uint32_t bits = 0;
  friend bool operator==(const FileMode&, const FileMode&) = default;
};

struct SocketConfig {
  std::filesystem::path path;  // absolute
  FileMode mode{0660};
  friend bool operator==(const SocketConfig&, const SocketConfig&) = default;
};

struct SensorModelConfig {
  SensorModelPreset preset = SensorModelPreset::kWarren;
  // Given exactly when the preset is custom.
  std::optional<double> hit;
  std::optional<double> miss;
  std::optional<double> minimum;
  std::optional<double> maximum;

  SensorModel resolved() const;
  friend bool operator==(const SensorModelConfig&, const SensorModelConfig&) = default;
};

enum class TerrainProfile : std::uint8_t { kRobust, kPaper };

struct TerrainSettings {
  TerrainProfile profile = TerrainProfile::kRobust;
  double saturation = 0.5;
  double step_harmless_m = 0.05;
  double step_critical_m = 0.20;
  CostRule fusion = CostRule::kInformation;

  TerrainConfig resolved() const;
  friend bool operator==(const TerrainSettings&, const TerrainSettings&) = default;
};

struct MapConfig {
  double resolution_m = 0.1;
  SensorModelConfig sensor_model;
  bool one_ray_per_end_voxel = false;

  friend bool operator==(const MapConfig&, const MapConfig&) = default;
};

// How the own layer is published, and layers are kept.
struct LayerSettings {
  double tick_s = 1.0;
  bool hold_ragged_free = true;
  bool hold_small_cost_changes = true;
  double flush_after_s = 30.0;
  std::uint32_t packet_bytes = 1200;
  double rest_after_s = 60.0;

  PublishingConfig resolved() const;
  std::uint32_t rest_after_ticks() const;
  friend bool operator==(const LayerSettings&, const LayerSettings&) = default;
};

struct IngestConfig {
  std::uint32_t queue_scans = 8;
  std::uint32_t max_points = 262144;
  std::uint32_t max_clients = 16;
  double message_timeout_s = 5.0;
  friend bool operator==(const IngestConfig&, const IngestConfig&) = default;
};

struct SensorConfig {
  std::string name = "lidar";
  double min_range_m = 0.3;
  std::optional<double> max_range_m = 20.0;
  // Both or none.
  std::optional<Eigen::Vector3d> body_box_low_m;
  std::optional<Eigen::Vector3d> body_box_high_m;
  bool carve_no_returns = false;

  SensorFilter filter() const;
  friend bool operator==(const SensorConfig&, const SensorConfig&) = default;
};

struct LogConfig {
  LogLevel level = LogLevel::kInfo;
  LogFormat format = LogFormat::kAuto;
  friend bool operator==(const LogConfig&, const LogConfig&) = default;
};

// A radio or cable of the mesh; the units of its numbers are those of the system.
struct MeshInterfaceConfig {
  std::string name = "wlan0";
  bool ipv4 = true;
  bool ipv6 = false;
  bool broadcast = false;
  bool group_packets = false;
  std::uint32_t mtu_bytes = 1428;
  std::optional<double> ceiling_kbit_s;
  std::vector<MeshAddress> seeds;
  friend bool operator==(const MeshInterfaceConfig&, const MeshInterfaceConfig&) = default;
};

// How this node meets the others; off while no interface is named.
struct MeshSettings {
  std::filesystem::path key_file{"/etc/warren/fleet.key"};
  std::uint32_t port = 7718;
  std::uint32_t group_port = 7717;
  bool group_loop = false;
  double shutdown_s = 3.0;
  std::vector<MeshInterfaceConfig> interfaces;

  bool is_on() const { return !interfaces.empty(); }
  friend bool operator==(const MeshSettings&, const MeshSettings&) = default;
};

inline constexpr std::uint64_t kBytesPerMegabyte = 1'000'000;

enum class SharePolicyChoice : std::uint8_t { kEverything, kNear, kNothing };

// Which blocks of the layers of others are copied here.
struct ShareSettings {
  SharePolicyChoice policy = SharePolicyChoice::kEverything;
  double radius_m = 50.0;
  std::uint32_t memory_mb_max = 2048;
  friend bool operator==(const ShareSettings&, const ShareSettings&) = default;
};

// What survives a restart.
struct StoreSettings {
  bool enabled = true;
  std::filesystem::path file{"/var/lib/warren/warren.db"};
  std::uint32_t disk_mb_max = 4096;
  friend bool operator==(const StoreSettings&, const StoreSettings&) = default;
};

// Where the map frame lies in the fleet's at the start: surveyed, level.
struct SurveyedPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double yaw_deg = 0.0;

  Pose pose() const;
  friend bool operator==(const SurveyedPose&, const SurveyedPose&) = default;
};

// Everything an operator can set, with its defaults; schema.hpp tells names, ranges and meaning.
struct Config {
  struct Node {
    std::string name = "robot";
    Role role = Role::kRobot;
    SurveyedPose fleet_T_map;
    friend bool operator==(const Node&, const Node&) = default;
  };
  struct Sockets {
    SocketConfig ingest{"/run/warren/ingest.sock"};
    SocketConfig control{"/run/warren/control.sock"};
    friend bool operator==(const Sockets&, const Sockets&) = default;
  };

  Node node;
  Sockets sockets;
  MapConfig map;
  TerrainSettings terrain;
  LayerSettings layer;
  IngestConfig ingest;
  std::vector<SensorConfig> sensors{SensorConfig{}};
  MeshSettings mesh;
  ShareSettings share;
  StoreSettings store;
  LogConfig log;

  // The defaults of a base: it has no sensors.
  static Config of_base();
  SelfMapConfig self_map() const;
  friend bool operator==(const Config&, const Config&) = default;
};

}  // namespace warren
