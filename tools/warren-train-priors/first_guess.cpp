// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-train-priors/first_guess.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace warren {
namespace {

using namespace diff_context;

// How often each state is met, relative to the others.
using Weights = std::array<int, kDiffStates>;

Probability odds(int for_set, int for_clear) {
  constexpr int kLeast = 512;  // of 65536: no prior is surer than this
  const int probability = static_cast<int>(std::int64_t{65536} * for_set / (for_set + for_clear));
  return static_cast<Probability>(std::clamp(probability, kLeast, 65536 - kLeast));
}

// Things look like their neighbours: each adds its weight to its own state.
Weights weigh_neighbours(std::size_t neighbourhood, std::size_t faces, const Weights& start,
                         const Weights& step) {
  Weights weights = start;
  for (std::size_t face = 0; face < faces; ++face) {
    const std::size_t state = neighbourhood >> 2 * face & 3;
    weights[state] += step[state];
  }
  return weights;
}

void set_states(DiffPriors& priors, std::size_t first, const Weights& weights, bool can_be_mixed) {
  const auto [unchanged, free, occupied, mixed] = weights;
  priors[first] = odds(unchanged, free + occupied + (can_be_mixed ? mixed : 0));
  if (can_be_mixed) priors[first + 1] = odds(mixed, free + occupied);
  priors[first + (can_be_mixed ? 2 : 1)] = odds(occupied, free);
}

// The last of eight by the three parts above it. The two states that are not excluded stand in the
// order of their numbers; the coder asks for the higher.
void set_lasts(DiffPriors& priors) {
  for (std::size_t last = 0; last < kLastNeighbourhoods; ++last) {
    const std::size_t excluded = last >> 6;
    const std::size_t low = excluded == 0 ? 1 : 0;
    const std::size_t high = excluded == 2 ? 1 : 2;
    const Weights weights = weigh_neighbours(last, 3, {2, 2, 2, 4}, {6, 6, 4, 4});
    priors[kLastCube + last * (kStateBits - 1)] = odds(weights[3], weights[low] + weights[high]);
    priors[kLastCube + last * (kStateBits - 1) + 1] = odds(weights[high], weights[low]);
    priors[kLastVoxel + last] = odds(weights[high], weights[low]);
  }
}

// Costs peak at their neighbours' mean, the less they spread the more.
void set_costs(DiffPriors& priors, std::size_t mean_in_halves, std::size_t spread) {
  constexpr std::array<int, kCostSpreads> kPeaks = {24, 36, 48, 24, 12, 6, 4};
  std::array<int, 2 * kCostTree> weights{};
  for (std::size_t cost = 1; cost < kCostTree; ++cost) {
    const int halves = std::abs(2 * static_cast<int>(cost) - static_cast<int>(mean_in_halves));
    weights[kCostTree + cost] =
        mean_in_halves == 0 ? (cost == 1 ? 16 : 2) : 1 + 2 * kPeaks[spread] / (2 + halves * halves);
  }
  for (std::size_t node = kCostTree - 1; node > 0; --node) {
    weights[node] = weights[2 * node] + weights[2 * node + 1];
    priors[kCost + (mean_in_halves * kCostSpreads + spread) * kCostTree + node] =
        odds(weights[2 * node + 1], weights[2 * node]);
  }
}

void set_number(DiffPriors& priors, std::size_t first, const std::array<int, 8>& length_weights) {
  std::array<int, 2 * kNumberBits> weights{};
  for (std::size_t length = 0; length < kNumberBits; ++length) {
    weights[kNumberBits + length] = length < length_weights.size() ? length_weights[length] : 1;
  }
  for (std::size_t node = kNumberBits - 1; node > 0; --node) {
    weights[node] = weights[2 * node] + weights[2 * node + 1];
    priors[first + node] = odds(weights[2 * node + 1], weights[2 * node]);
  }
}

}  // namespace

DiffPriors first_guess() {
  DiffPriors priors(kCount, kEvenOdds);
  for (std::size_t past = 0; past < kPastNeighbourhoods; ++past) {
    set_states(priors, kCell + past * kStateBits,
               weigh_neighbours(past, 3, {4, 2, 1, 4}, {4, 4, 1, 6}), true);
  }
  for (std::size_t faces = 0; faces < kFaceSets * kFaceNeighbourhoods; ++faces) {
    set_states(priors, kCube + faces * kStateBits,
               weigh_neighbours(faces, 6, {2, 2, 1, 4}, {6, 6, 1, 4}), true);
    set_states(priors, kVoxel + faces * (kStateBits - 1),
               weigh_neighbours(faces, 6, {1, 1, 1, 0}, {5, 5, 5, 0}), false);
  }
  set_lasts(priors);
  for (std::size_t mean = 0; mean < kCostMeans; ++mean) {
    for (std::size_t spread = 0; spread < kCostSpreads; ++spread) set_costs(priors, mean, spread);
  }
  constexpr std::array<int, 4> kStairsOf16 = {1, 6, 12, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    priors[kStair + i] = odds(kStairsOf16[i], 16 - kStairsOf16[i]);
  }
  for (std::size_t with_data = 0; with_data < 3; ++with_data) {
    for (std::size_t without = 0; without < 3; ++without) {
      priors[kNoData + with_data * 3 + without] =
          odds(1 + static_cast<int>(4 * without), 1 + static_cast<int>(4 * with_data));
    }
  }
  priors[kMoreBlocks] = odds(80, 1);
  priors[kRaw] = odds(1, 200);
  priors[kReplaces] = odds(1, 15);
  priors[kReplaces + 1] = odds(15, 1);
  priors[kSameAge] = odds(2, 1);
  set_number(priors, kAge, {64, 32, 32, 32, 16, 16, 8, 4});
  set_number(priors, kKeyStep, {512, 128, 128, 96, 64, 32, 16, 16});
  return priors;
}

}  // namespace warren
