// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/voxel/sensor_model.hpp"

namespace warren {

// Distances at which coverage and deviation are told, metres.
inline constexpr std::array<double, 4> kQualityDistancesM = {1.0, 0.5, 0.2, 0.1};

struct NamedModel {
  std::string name;
  SensorModel model;
};

// One map against the world that it shows. Shares lie in 0..1.
struct MapQuality {
  std::string world;
  std::string model;
  double resolution_m = 0.0;
  // Of the surface that the sensor could see, within a distance of a map point (a centre of an
  // occupied voxel); and of the map points, farther than that from any surface.
  std::array<double, kQualityDistancesM.size()> coverage{};
  std::array<double, kQualityDistancesM.size()> deviation{};
  double occupied_precision = 0.0;     // of the occupied voxels, with a surface in them
  double occupied_recall = 0.0;        // of the voxels with visible surface in them, occupied
  double false_free = 0.0;             // of the same, free
  std::optional<double> cable_recall;  // of the voxels with visible cable in them, occupied
  std::uint64_t cable_voxels = 0;
  std::uint64_t map_points = 0;  // occupied voxels
  std::uint64_t voxels_free = 0;
};

struct MapQualityOptions {
  std::vector<std::string> worlds = {"cave", "tunnel", "urban"};
  std::vector<double> resolutions_m = {0.1, 0.2};
  std::vector<NamedModel> models;
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  double max_range_m = 20.0;
};

// One robot explores each world, its poses true; every model maps the same scans.
tl::expected<std::vector<MapQuality>, std::string> bench_map_quality(
    const MapQualityOptions& options);

std::string to_text(const std::vector<MapQuality>& results);
std::string to_json(const std::vector<MapQuality>& results, const MapQualityOptions& options);

}  // namespace warren
