// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace warren {

// Scores of things that are hazards or not, 0 safe .. 1 hazard, against the truth about them.
class LabelAgreement {
 public:
  // None: no data. It counts as neither score, and is told apart.
  void add(std::optional<double> score, bool is_hazard);

  std::uint64_t safe_count() const { return safe_.size() + safe_without_data_; }
  std::uint64_t hazard_count() const { return hazards_.size() + hazards_without_data_; }
  // Shares of those with data; none if there are no such.
  std::optional<double> false_safe(double threshold) const;    // hazards that score below it
  std::optional<double> false_hazard(double threshold) const;  // safe ones at or above it
  // Shares of all.
  std::optional<double> safe_without_data() const;
  std::optional<double> hazards_without_data() const;
  // How likely a hazard scores higher than a safe one, both drawn by chance; equal scores count
  // half (Mann and Whitney). Of those with data; none if either kind is missing.
  std::optional<double> roc_auc() const;

 private:
  std::vector<double> safe_;
  std::vector<double> hazards_;
  std::uint64_t safe_without_data_ = 0;
  std::uint64_t hazards_without_data_ = 0;
};

}  // namespace warren
