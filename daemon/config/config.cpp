// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/config.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace warren {
namespace {

// Rounded up, at least one.
std::uint32_t ticks_in(double time_s, double tick_s) {
  return static_cast<std::uint32_t>(std::max(std::ceil(time_s / tick_s), 1.0));
}

}  // namespace

SensorModel SensorModelConfig::resolved() const {
  switch (preset) {
    case SensorModelPreset::kWarren:
      return SensorModel::ours();
    case SensorModelPreset::kOctomap:
      return SensorModel::octomap_default();
    case SensorModelPreset::kField:
      return SensorModel::field();
    case SensorModelPreset::kCustom:
      break;
  }
  SensorModel model;
  model.hit = hit.value_or(model.hit);
  model.miss = miss.value_or(model.miss);
  model.minimum = minimum.value_or(model.minimum);
  model.maximum = maximum.value_or(model.maximum);
  return model;
}

TerrainConfig TerrainSettings::resolved() const {
  TerrainConfig config =
      profile == TerrainProfile::kPaper ? TerrainConfig::paper() : TerrainConfig::robust();
  config.cost.saturation = static_cast<float>(saturation);
  if (config.cost.step) {
    config.cost.step->limits = {static_cast<float>(step_harmless_m),
                                static_cast<float>(step_critical_m)};
  }
  return config;
}

PublishingConfig LayerSettings::resolved() const {
  return {
      {hold_ragged_free, hold_small_cost_changes}, packet_bytes, ticks_in(flush_after_s, tick_s)};
}

std::uint32_t LayerSettings::rest_after_ticks() const { return ticks_in(rest_after_s, tick_s); }

Pose SurveyedPose::pose() const {
  const double yaw_rad = yaw_deg * std::numbers::pi / 180.0;
  return {{x_m, y_m, z_m},
          Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
}

Config Config::of_base() {
  Config config;
  config.node.name = "base";
  config.node.role = Role::kBase;
  config.sensors.clear();
  return config;
}

SelfMapConfig Config::self_map() const {
  SelfMapConfig config{
      map.resolution_m, map.sensor_model.resolved(), map.one_ray_per_end_voxel, {}};
  config.cost_fusion.rule = terrain.fusion;
  return config;
}

SensorFilter SensorConfig::filter() const {
  SensorFilter filter;
  filter.min_range_m = min_range_m;
  filter.max_range_m = max_range_m;
  if (body_box_low_m && body_box_high_m)
    filter.body_box = BodyBox{*body_box_low_m, *body_box_high_m};
  filter.carve_no_returns = carve_no_returns;
  return filter;
}

}  // namespace warren
