// SPDX-License-Identifier: Apache-2.0
#include "tools/link/capacity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace warren {
namespace {

constexpr LinkNanoseconds kPerMillisecond = 1'000'000;
constexpr double kPerSecond = 1e9;

// When opportunity number `index` comes, counted over all repetitions of the list.
LinkNanoseconds opportunity_at(const Opportunities& list, std::uint64_t index) {
  const std::uint64_t round = index / list.at_ms.size();
  const std::uint64_t at_ms = round * list.at_ms.back() + list.at_ms[index % list.at_ms.size()];
  return static_cast<LinkNanoseconds>(at_ms) * kPerMillisecond;
}

// The first one at `time` or later.
std::uint64_t first_opportunity(const Opportunities& list, LinkNanoseconds time) {
  const LinkNanoseconds period = LinkNanoseconds{list.at_ms.back()} * kPerMillisecond;
  const auto round = static_cast<std::uint64_t>(time / period);
  // The last one of a round falls together with the start of the next.
  std::uint64_t index = (round == 0 ? 0 : round - 1) * list.at_ms.size();
  std::uint64_t end = (round + 1) * list.at_ms.size();
  while (index < end) {
    const std::uint64_t middle = index + (end - index) / 2;
    if (opportunity_at(list, middle) < time) {
      index = middle + 1;
    } else {
      end = middle;
    }
  }
  return index;
}

}  // namespace

Capacity::Capacity(std::vector<RateStep> steps) : kind_(std::move(steps)) {
  const auto& rates = std::get<std::vector<RateStep>>(kind_);
  assert(!rates.empty() && rates.front().at == Duration{});
  for (std::size_t i = 0; i < rates.size(); ++i) {
    assert(rates[i].bit_s >= 0.0);
    assert(i == 0 || rates[i - 1].at < rates[i].at);
  }
}

Capacity::Capacity(Opportunities opportunities) : kind_(std::move(opportunities)) {
  const auto& at_ms = std::get<Opportunities>(kind_).at_ms;
  assert(!at_ms.empty() && at_ms.back() > 0 && std::is_sorted(at_ms.begin(), at_ms.end()));
}

CapacityUse Capacity::after(CapacityUse last, LinkNanoseconds start, std::size_t bytes) const {
  if (last.at == kNeverPasses || start == kNeverPasses) return {kNeverPasses, 0, 0};
  start = std::max(start, last.at);
  if (std::holds_alternative<std::monostate>(kind_)) return {start, 0, 0};
  if (std::holds_alternative<Opportunities>(kind_)) return by_opportunity(last, start, bytes);
  return by_rate(start, bytes);
}

CapacityUse Capacity::by_rate(LinkNanoseconds start, std::size_t bytes) const {
  const auto& steps = std::get<std::vector<RateStep>>(kind_);
  auto step = std::upper_bound(
      steps.begin(), steps.end(), start,
      [](LinkNanoseconds time, const RateStep& s) { return time < nanoseconds(s.at); });
  double bits = 8.0 * static_cast<double>(bytes);
  for (--step;; ++step) {
    const bool last = step + 1 == steps.end();
    const double needed = step->bit_s > 0.0 ? bits / step->bit_s * kPerSecond : INFINITY;
    const LinkNanoseconds end = last ? kNeverPasses : nanoseconds((step + 1)->at);
    if (needed <= static_cast<double>(end - start)) return {start + std::llround(needed), 0, 0};
    if (last) return {kNeverPasses, 0, 0};
    bits -= step->bit_s * static_cast<double>(end - start) / kPerSecond;
    start = end;
  }
}

CapacityUse Capacity::by_opportunity(CapacityUse last, LinkNanoseconds start,
                                     std::size_t bytes) const {
  const auto& list = std::get<Opportunities>(kind_);
  const std::uint64_t index = std::max(first_opportunity(list, start), last.opportunity);
  const std::size_t used = index == last.opportunity ? last.opportunity_bytes : 0;
  const std::size_t end = used + bytes;  // counted from the beginning of opportunity `index`
  if (end == 0) return {opportunity_at(list, index), index, 0};
  const std::uint64_t final_index = index + (end - 1) / Opportunities::kOpportunityBytes;
  const std::size_t final_bytes = (end - 1) % Opportunities::kOpportunityBytes + 1;
  return {opportunity_at(list, final_index), final_index, final_bytes};
}

}  // namespace warren
