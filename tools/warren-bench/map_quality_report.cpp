// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/map_quality.hpp"

namespace warren {
namespace {

// 0.5 becomes 0p5m.
std::string distance_name(double distance_m) {
  const long tenths = std::lround(10.0 * distance_m);
  return fmt::format("{}p{}m", tenths / 10, tenths % 10);
}

nlohmann::ordered_json as_json(const MapQuality& q) {
  nlohmann::ordered_json json = {
      {"world", q.world}, {"sensor_model", q.model}, {"resolution_m", q.resolution_m}};
  for (std::size_t i = 0; i < kQualityDistancesM.size(); ++i) {
    json["coverage_" + distance_name(kQualityDistancesM[i])] = q.coverage[i];
  }
  for (std::size_t i = 0; i < kQualityDistancesM.size(); ++i) {
    json["deviation_" + distance_name(kQualityDistancesM[i])] = q.deviation[i];
  }
  json["occupied_precision"] = q.occupied_precision;
  json["occupied_recall"] = q.occupied_recall;
  json["false_free"] = q.false_free;
  json["cable_recall"] = q.cable_recall ? nlohmann::ordered_json(*q.cable_recall) : nullptr;
  json["cable_voxels"] = q.cable_voxels;
  json["map_points"] = q.map_points;
  json["voxels_free"] = q.voxels_free;
  return json;
}

}  // namespace

std::string to_text(const std::vector<MapQuality>& results) {
  std::string text = fmt::format("{:<8}{:>6} {:<10}", "world", "res m", "model");
  for (const double d : kQualityDistancesM) text += fmt::format("{:>9}", fmt::format("cov {}", d));
  for (const double d : kQualityDistancesM) text += fmt::format("{:>9}", fmt::format("dev {}", d));
  text +=
      fmt::format("{:>9}{:>9}{:>9}{:>9}{:>10}\n", "precis.", "recall", "f.free", "cable", "points");
  for (const MapQuality& q : results) {
    text += fmt::format("{:<8}{:>6} {:<10}", q.world, q.resolution_m, q.model);
    for (const double share : q.coverage) text += fmt::format("{:>9.4f}", share);
    for (const double share : q.deviation) text += fmt::format("{:>9.4f}", share);
    text += fmt::format("{:>9.4f}{:>9.4f}{:>9.4f}", q.occupied_precision, q.occupied_recall,
                        q.false_free);
    text += q.cable_recall ? fmt::format("{:>9.3f}", *q.cable_recall) : fmt::format("{:>9}", "-");
    text += fmt::format("{:>10}\n", q.map_points);
  }
  return text;
}

std::string to_json(const std::vector<MapQuality>& results, const MapQualityOptions& options) {
  const Machine machine = this_machine();
  nlohmann::ordered_json json = {
      {"benchmark", "map-quality"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"seed", options.seed},
      {"seconds", options.duration_s},
      {"max_range_m", options.max_range_m}};
  for (const NamedModel& model : options.models) {
    json["sensor_models"][model.name] = {{"hit", model.model.hit},
                                         {"miss", model.model.miss},
                                         {"minimum", model.model.minimum},
                                         {"maximum", model.model.maximum}};
  }
  json["results"] = nlohmann::ordered_json::array();
  for (const MapQuality& quality : results) json["results"].push_back(as_json(quality));
  return json.dump(2);
}

}  // namespace warren
