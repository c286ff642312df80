// SPDX-License-Identifier: Apache-2.0
#include "core/voxel/voxel_cost.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace warren;

namespace {

constexpr float kStep = 1.0F / 65535.0F;
constexpr double kOccupied = 0.97;

VoxelCost close_by(float cost) { return {{}, cost, 1.0F}; }

FusedCost after(const CostFusion& fusion, FusedCost fused, const VoxelCost& measured, int scans) {
  for (int i = 0; i < scans; ++i) fused = fusion.next(fused, measured, kOccupied);
  return fused;
}

const CostFusion kDefault{CostFusionConfig{}};
const CostFusion kPaper{CostFusionConfig{CostRule::kPaper}};

}  // namespace

TEST_CASE("a constant cost is what the voxel comes to, from any start and however little is seen") {
  for (const float truth : {0.0F, 0.01F, 0.1F, 0.35F, 0.99F, 1.0F}) {
    for (const float start : {0.0F, 0.5F, 1.0F}) {
      for (const float information : {1.0F, 0.2F, 0.001F}) {
        const VoxelCost measured{{}, truth, information};
        const FusedCost fused = after(kDefault, kDefault.first(close_by(start)), measured, 60000);
        CHECK(std::abs(fused.value() - truth) <= 2 * kStep);
      }
    }
  }
}

TEST_CASE("the first cost of a voxel is taken whole, and never made easier") {
  for (int i = 0; i <= 1000; ++i) {
    const float cost = static_cast<float>(i) / 1000.0F;
    const FusedCost first = kDefault.first(close_by(cost));
    CHECK(first.cost >= cost * 65535.0F);
    CHECK(first.value() - cost <= kStep);
    CHECK(kPaper.first(close_by(cost)).cost == first.cost);
  }
}

TEST_CASE("an outlier is outvoted, whenever it comes") {
  const FusedCost easy = after(kDefault, kDefault.first(close_by(0.02F)), close_by(0.02F), 30);
  CHECK(kDefault.next(easy, close_by(1.0F), kOccupied).value() < 0.10F);

  FusedCost fused = kDefault.first(close_by(1.0F));
  FusedCost paper = kPaper.first(close_by(1.0F));
  int scans = 0;
  for (; fused.value() > 0.10F; ++scans) {
    fused = kDefault.next(fused, close_by(0.0F), kOccupied);
    paper = kPaper.next(paper, close_by(0.0F), kOccupied);
  }
  CHECK(scans <= 10);
  CHECK(paper.value() > 0.7F);
}

TEST_CASE("a change is followed from both sides, sooner than by the paper's rule") {
  for (const auto& [before, now] : {std::pair{0.0F, 0.8F}, std::pair{0.8F, 0.0F}}) {
    FusedCost fused = after(kDefault, kDefault.first(close_by(before)), close_by(before), 100);
    fused = after(kDefault, fused, close_by(now), 50);
    CHECK(std::abs(fused.value() - now) < 0.05F);
    FusedCost paper = after(kPaper, kPaper.first(close_by(before)), close_by(before), 100);
    paper = after(kPaper, paper, close_by(now), 50);
    CHECK(std::abs(paper.value() - now) > std::abs(fused.value() - now));
  }
}

TEST_CASE("the paper's rule is Eq. 4 as printed") {
  CHECK(rc::check("Eq. 4", [] {
    const auto unit = [] { return static_cast<float>(*rc::gen::inRange(0, 1001)) / 1000.0F; };
    const float old_cost = unit();
    const float new_cost = unit();
    const double occupancy = unit();
    const FusedCost fused =
        kPaper.next(kPaper.first(close_by(old_cost)), close_by(new_cost), occupancy);
    const double printed = old_cost * occupancy + new_cost * (1.0 - occupancy);
    RC_ASSERT(std::abs(static_cast<double>(fused.value()) - printed) <=
              2.0 * static_cast<double>(kStep));
  }));
}

TEST_CASE("a fused cost goes towards what is measured and never past it") {
  CHECK(rc::check("between", [] {
    const auto measured = [] {
      return VoxelCost{{},
                       static_cast<float>(*rc::gen::inRange(0, 65536)) / 65535.0F,
                       static_cast<float>(*rc::gen::inRange(0, 1001)) / 1000.0F};
    };
    FusedCost fused = kDefault.first(measured());
    for (int i = 0; i < 20; ++i) {
      const VoxelCost next = measured();
      const FusedCost target = kDefault.first(next);
      const FusedCost before = fused;
      fused = kDefault.next(before, next, kOccupied);
      RC_ASSERT(fused.cost >= std::min(before.cost, target.cost));
      RC_ASSERT(fused.cost <= std::max(before.cost, target.cost));
      RC_ASSERT((fused.cost == before.cost) == (before.cost == target.cost));
    }
  }));
}

TEST_CASE("what is seen from close by outweighs what was seen from afar") {
  const VoxelCost far{{}, 0.9F, 0.05F};
  const FusedCost from_afar = after(kDefault, kDefault.first(far), far, 9);
  const FusedCost now = kDefault.next(from_afar, close_by(0.0F), kOccupied);
  CHECK(now.value() < 0.35F);
  CHECK(kDefault.next(now, far, kOccupied).value() < 0.40F);
}

TEST_CASE("numbers that are no cost count as the worst") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  CHECK(kDefault.first(close_by(kNan)).cost == FusedCost::kImpossible);
  CHECK(kDefault.first(close_by(kInfinity)).cost == FusedCost::kImpossible);
  CHECK(kDefault.first(close_by(7.0F)).cost == FusedCost::kImpossible);
  CHECK(kDefault.first(close_by(-1.0F)).cost == 0);
  CHECK(kDefault.first({{}, 0.5F, kNan}).information == 1);
  CHECK(kDefault.first({{}, 0.5F, -kInfinity}).information == 1);
  CHECK(kDefault.first({{}, 0.5F, kInfinity}).information == CostFusion::kInformationSteps);
}
