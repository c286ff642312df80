// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "daemon/config/document.hpp"

namespace warren {
namespace {

void check_sensor_model(const SensorModelConfig& model, FaultList& faults) {
  const bool custom = model.preset == SensorModelPreset::kCustom;
  const auto check = [&](const char* name, const std::optional<double>& value) {
    const std::string key = std::string("map.sensor_model.") + name;
    if (custom && !value) faults.add(key, "missing: preset custom needs all four numbers");
    if (!custom && value) faults.add(key, "only with preset: custom");
  };
  check("hit", model.hit);
  check("miss", model.miss);
  check("minimum", model.minimum);
  check("maximum", model.maximum);
}

void check_terrain(const TerrainSettings& terrain, FaultList& faults) {
  if (terrain.step_critical_m <= terrain.step_harmless_m) {
    faults.add("terrain.step_critical_m", "must be above step_harmless_m");
  }
}

void check_sockets(const Config::Sockets& sockets, FaultList& faults) {
  if (sockets.ingest.path == sockets.control.path) {
    faults.add("sockets.control.path", "is sockets.ingest.path too; they need two");
  }
}

void check_body_box(const SensorConfig& sensor, const std::string& place, FaultList& faults) {
  const auto& low = sensor.body_box_low_m;
  const auto& high = sensor.body_box_high_m;
  if (low.has_value() != high.has_value()) {
    faults.add(place + (low ? ".body_box.low_m" : ".body_box.high_m"),
               "a body box needs both low_m and high_m");
  } else if (low && (low->array() >= high->array()).any()) {
    faults.add(place + ".body_box.low_m", "must be below high_m on every axis");
  }
}

void check_sensor(const SensorConfig& sensor, const std::string& place, FaultList& faults) {
  if (sensor.max_range_m && *sensor.max_range_m <= sensor.min_range_m) {
    faults.add(place + ".max_range_m", "must be above min_range_m");
  }
  if (sensor.carve_no_returns && !sensor.max_range_m) {
    faults.add(place + ".carve_no_returns", "needs max_range_m: how far to carve");
  }
  check_body_box(sensor, place, faults);
}

void check_sensors(const Config& config, FaultList& faults) {
  const bool is_base = config.node.role == Role::kBase;
  if (is_base && !config.sensors.empty()) {
    faults.add("sensors", "a base has none: leave them out, or let node.role be robot");
  }
  if (!is_base && config.sensors.empty()) faults.add("sensors", "a robot needs at least one");
  std::set<std::string> names;
  for (std::size_t i = 0; i < config.sensors.size(); ++i) {
    const std::string place = "sensors[" + std::to_string(i) + "]";
    check_sensor(config.sensors[i], place, faults);
    if (!names.insert(config.sensors[i].name).second) {
      faults.add(place + ".name", "'" + config.sensors[i].name + "' is taken by a sensor above");
    }
  }
}

void check_mesh(const MeshSettings& mesh, FaultList& faults) {
  if (mesh.port == mesh.group_port) {
    faults.add("mesh.port", "is mesh.group_port too; they need two");
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const MeshInterfaceConfig& interface = mesh.interfaces[i];
    const std::string place = "mesh.interfaces[" + std::to_string(i) + "]";
    if (!names.insert(interface.name).second) {
      faults.add(place + ".name", "'" + interface.name + "' is taken by an interface above");
    }
    if (!interface.ipv4 && !interface.ipv6) {
      faults.add(place + ".ipv4", "must be true where ipv6 is not");
    }
    if (interface.broadcast && !interface.ipv4) faults.add(place + ".broadcast", "needs ipv4");
  }
}

// Robots count on it to have everything.
void check_share(const Config& config, FaultList& faults) {
  const bool is_base = config.node.role == Role::kBase;
  if (is_base && config.share.policy != SharePolicyChoice::kEverything) {
    faults.add("share.policy", "a base holds everything: leave it out, or let node.role be robot");
  }
}

}  // namespace

void check_consistency(const Config& config, FaultList& faults) {
  check_sensor_model(config.map.sensor_model, faults);
  check_terrain(config.terrain, faults);
  check_sockets(config.sockets, faults);
  check_sensors(config, faults);
  check_mesh(config.mesh, faults);
  check_share(config, faults);
}

}  // namespace warren
