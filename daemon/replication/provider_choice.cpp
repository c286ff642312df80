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

// Lower is better.
auto rank_of(const Candidate& candidate) {
  const Hops way = way_through(candidate);
  const bool only_leads = way == kNoWay && !candidate.leads;
  return std::tuple(candidate.is_idle, way, only_leads, UINT32_MAX - candidate.highest,
                    -candidate.rate_bit_s, candidate.member);
}

bool is_better_by_much(const Candidate& best, const Candidate& current) {
  if (current.is_idle != best.is_idle) return current.is_idle;
  const Hops best_way = way_through(best);
  const Hops current_way = way_through(current);
  if (best.is_origin || current_way == kNoWay) {
    return best_way < current_way || (best.leads && !current.leads && current_way == kNoWay);
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
