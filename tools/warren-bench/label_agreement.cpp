// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/label_agreement.hpp"

#include <algorithm>

namespace warren {
namespace {

std::optional<double> share(std::uint64_t part, std::uint64_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

std::uint64_t count_below(const std::vector<double>& scores, double threshold) {
  const auto below =
      std::count_if(scores.begin(), scores.end(), [&](double score) { return score < threshold; });
  return static_cast<std::uint64_t>(below);
}

}  // namespace

void LabelAgreement::add(std::optional<double> score, bool is_hazard) {
  if (score) {
    (is_hazard ? hazards_ : safe_).push_back(*score);
  } else {
    ++(is_hazard ? hazards_without_data_ : safe_without_data_);
  }
}

std::optional<double> LabelAgreement::false_safe(double threshold) const {
  return share(count_below(hazards_, threshold), hazards_.size());
}

std::optional<double> LabelAgreement::false_hazard(double threshold) const {
  return share(safe_.size() - count_below(safe_, threshold), safe_.size());
}

std::optional<double> LabelAgreement::safe_without_data() const {
  return share(safe_without_data_, safe_count());
}

std::optional<double> LabelAgreement::hazards_without_data() const {
  return share(hazards_without_data_, hazard_count());
}

std::optional<double> LabelAgreement::roc_auc() const {
  if (safe_.empty() || hazards_.empty()) return std::nullopt;
  std::vector<double> safe = safe_;
  std::sort(safe.begin(), safe.end());
  double wins = 0.0;
  for (const double hazard : hazards_) {
    const auto [first, end] = std::equal_range(safe.begin(), safe.end(), hazard);
    wins += static_cast<double>(first - safe.begin()) + 0.5 * static_cast<double>(end - first);
  }
  return wins / (static_cast<double>(safe.size()) * static_cast<double>(hazards_.size()));
}

}  // namespace warren
