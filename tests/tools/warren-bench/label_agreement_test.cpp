// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/label_agreement.hpp"

#include <random>

#include <doctest/doctest.h>

using namespace warren;

namespace {

struct Scored {
  double score = 0.0;
  bool is_hazard = false;
};

LabelAgreement agreement_of(const std::vector<Scored>& all) {
  LabelAgreement agreement;
  for (const Scored& one : all) agreement.add(one.score, one.is_hazard);
  return agreement;
}

double brute_force_auc(const std::vector<Scored>& all) {
  double wins = 0.0;
  double pairs = 0.0;
  for (const Scored& hazard : all) {
    for (const Scored& safe : all) {
      if (!hazard.is_hazard || safe.is_hazard) continue;
      pairs += 1.0;
      if (hazard.score > safe.score) wins += 1.0;
      if (hazard.score == safe.score) wins += 0.5;
    }
  }
  return wins / pairs;
}

}  // namespace

TEST_CASE("perfect, reversed and indifferent scores have areas of 1, 0 and a half") {
  CHECK(agreement_of({{0.1, false}, {0.2, false}, {0.3, true}}).roc_auc() == 1.0);
  CHECK(agreement_of({{0.3, false}, {0.2, true}}).roc_auc() == 0.0);
  CHECK(agreement_of({{0.5, false}, {0.5, false}, {0.5, true}}).roc_auc() == 0.5);
}

TEST_CASE("the area is the share of pairs in the right order, ties counting half") {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    std::vector<Scored> all = {{0.4, false}, {0.4, true}};
    for (int i = 0; i < 60; ++i) {
      all.push_back({static_cast<double>(random() % 10) / 10.0, random() % 3 == 0});
    }
    CHECK(*agreement_of(all).roc_auc() == doctest::Approx(brute_force_auc(all)).epsilon(1e-12));
  }
}

TEST_CASE("a score on the threshold is no safe one") {
  const LabelAgreement agreement =
      agreement_of({{0.05, true}, {0.10, true}, {0.15, true}, {0.30, true}, {0.10, false}});
  CHECK(agreement.false_safe(0.10) == 0.25);
  CHECK(agreement.false_safe(0.20) == 0.75);
  CHECK(agreement.false_hazard(0.10) == 1.0);
  CHECK(agreement.false_hazard(0.20) == 0.0);
}

TEST_CASE("what has no data is neither, and is told apart") {
  LabelAgreement agreement = agreement_of({{0.0, false}, {1.0, true}});
  agreement.add(std::nullopt, true);
  agreement.add(std::nullopt, true);
  agreement.add(std::nullopt, false);
  CHECK(agreement.safe_count() == 2);
  CHECK(agreement.hazard_count() == 3);
  CHECK(agreement.safe_without_data() == 0.5);
  CHECK(*agreement.hazards_without_data() == doctest::Approx(2.0 / 3.0));
  CHECK(agreement.false_safe(0.10) == 0.0);
  CHECK(agreement.false_hazard(0.10) == 0.0);
  CHECK(agreement.roc_auc() == 1.0);
}

TEST_CASE("what cannot be said is not said") {
  const LabelAgreement only_safe = agreement_of({{0.0, false}});
  CHECK_FALSE(only_safe.roc_auc());
  CHECK_FALSE(only_safe.false_safe(0.10));
  CHECK_FALSE(only_safe.hazards_without_data());
}
