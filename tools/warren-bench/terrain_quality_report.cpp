// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/warren-bench/machine.hpp"
#include "tools/warren-bench/terrain_quality.hpp"

namespace warren {
namespace {

using Share = std::optional<double>;

std::string as_text(const Share& share) {
  return share ? fmt::format("{:>10.4f}", *share) : fmt::format("{:>10}", "-");
}

nlohmann::ordered_json as_json(const Share& share) {
  return share ? nlohmann::ordered_json(*share) : nullptr;
}

std::string name_of(const RangeBin& bin) { return fmt::format("{}-{}", bin.low_m, bin.high_m); }

nlohmann::ordered_json as_json(const TerrainQuality& q) {
  const LabelAgreement& a = q.agreement;
  return {{"profile", q.profile},
          {"world", q.world},
          {"vehicle", q.vehicle},
          {"range_bin", name_of(q.bin)},
          {"range_low_m", q.bin.low_m},
          {"range_high_m", q.bin.high_m},
          {"roc_auc", as_json(a.roc_auc())},
          {"false_safe_0p10", as_json(a.false_safe(0.10))},
          {"false_safe_0p20", as_json(a.false_safe(0.20))},
          {"false_hazard_0p10", as_json(a.false_hazard(0.10))},
          {"false_hazard_0p20", as_json(a.false_hazard(0.20))},
          {"places_safe", a.safe_count()},
          {"places_hazard", a.hazard_count()},
          {"places_mixed", q.mixed},
          {"safe_without_data", as_json(a.safe_without_data())},
          {"hazard_without_data", as_json(a.hazards_without_data())}};
}

}  // namespace

std::string to_text(const std::vector<TerrainQuality>& results) {
  std::string text =
      fmt::format("{:<8}{:<8}{:<7}{:>7}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>9}{:>9}{:>9}\n",
                  "profile", "world", "vehicle", "range", "ROC-AUC", "f.safe.10", "f.safe.20",
                  "f.haz.10", "f.haz.20", "safe n.d.", "haz. n.d.", "safe", "hazard", "mixed");
  for (const TerrainQuality& q : results) {
    const LabelAgreement& a = q.agreement;
    text += fmt::format("{:<8}{:<8}{:<7}{:>7}", q.profile, q.world, q.vehicle, name_of(q.bin));
    for (const Share& share :
         {a.roc_auc(), a.false_safe(0.10), a.false_safe(0.20), a.false_hazard(0.10),
          a.false_hazard(0.20), a.safe_without_data(), a.hazards_without_data()}) {
      text += as_text(share);
    }
    text += fmt::format("{:>9}{:>9}{:>9}\n", a.safe_count(), a.hazard_count(), q.mixed);
  }
  return text;
}

std::string to_json(const std::vector<TerrainQuality>& results,
                    const TerrainQualityOptions& options) {
  const Machine machine = this_machine();
  nlohmann::ordered_json json = {
      {"benchmark", "terrain-quality"},
      {"machine",
       {{"cpu", machine.cpu}, {"cpu_level", machine.cpu_level}, {"build", machine.build}}},
      {"seed", options.run.seed},
      {"seconds", options.run.duration_s},
      {"scan_period_s", options.run.scan_period_s},
      {"place_spacing_m", options.run.place_spacing_m},
      {"results", nlohmann::ordered_json::array()}};
  for (const TerrainQuality& quality : results) json["results"].push_back(as_json(quality));
  return json.dump(2);
}

}  // namespace warren
