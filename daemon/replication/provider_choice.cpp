// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/provider_choice.hpp"

#include <algorithm>
#include <tuple>

namespace warren::replication {
namespace {

// A way that leads through us is none.
Hops way_through(const Candidate& candidate) {
  if (candidate.is_origin) return 1;
  if (candidate.gets_it_here || candidate.hops >= kNoWay - 1) return kNoWay;
  return static_cast<Hops>(candidate.hops + 1);
}

bool is_of_use(const Candidate& candidate) {
  return way_through(candidate) < kNoWay || candidate.leads || candidate.is_current;
}

// The way, and what it is worth. Over a link that loses most it is no better than one through
// others; who is left for that has to become a good deal better to be taken again. Who copies a
// part alone, or has just begun, may never have the rest.
int length_through(const Candidate& candidate) {
  constexpr double kFringeLoss = 0.6;
  constexpr double kFringeLossOfOthers = 0.45;
  constexpr int kFringe = 3;
  constexpr int kPartial = 4;
  const Hops way = way_through(candidate);
  if (way == kNoWay) return 2 * kNoWay;
  const double limit = candidate.is_current ? kFringeLoss : kFringeLossOfOthers;
  return way + (candidate.loss > limit ? kFringe : 0) +
         (candidate.is_partial && !candidate.is_origin ? kPartial : 0);
}

// Lower is better.
auto rank_of(const Candidate& candidate) {
  const int way = length_through(candidate);
  const bool only_leads = way_through(candidate) == kNoWay && !candidate.leads;
  return std::tuple(candidate.is_idle, way, only_leads, UINT32_MAX - candidate.highest,
                    -candidate.rate_bit_s, candidate.member);
}

bool is_better_by_much(const Candidate& best, const Candidate& current) {
  if (current.is_idle != best.is_idle) return current.is_idle;
  const int best_way = length_through(best);
  const int current_way = length_through(current);
  const bool no_way = way_through(current) == kNoWay;
  if (best.is_origin || no_way) {
    return best_way < current_way || (best.leads && !current.leads && no_way);
  }
  return best_way + 1 < current_way;
}

}  // namespace

Choice choose_provider(std::span<const Candidate> candidates) {
  const Candidate* best = nullptr;
  const Candidate* current = nullptr;
  for (const Candidate& candidate : candidates) {
    if (!is_of_use(candidate)) continue;
    if (candidate.is_current) current = &candidate;
    if (best == nullptr || rank_of(candidate) < rank_of(*best)) best = &candidate;
  }
  if (best == nullptr) return {};
  if (current != nullptr && !is_better_by_much(*best, *current)) best = current;
  return {best->member, way_through(*best)};
}

}  // namespace warren::replication
