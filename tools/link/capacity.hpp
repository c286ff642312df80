// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "transport/mesh_time.hpp"

namespace warren {

// Since the link's start. Finer than the transport's microseconds: at 100 Mbit/s a packet takes 96
// of them.
using LinkNanoseconds = std::int64_t;
inline constexpr LinkNanoseconds kNeverPasses = INT64_MAX;

constexpr LinkNanoseconds nanoseconds(Duration time) { return time.count() * 1000; }

// From `at` on until the next step. Rate 0: nothing passes, what waits goes on waiting.
struct RateStep {
  Duration at{};
  double bit_s = 0.0;
};

// Moments at which kOpportunityBytes may pass, as mahimahi records them; what is not used then is
// gone. The last one is the period: the list starts over.
struct Opportunities {
  static constexpr std::size_t kOpportunityBytes = 1504;
  std::vector<std::uint32_t> at_ms;  // rising, the last one above 0
};

// Where a sender stands in its use of a capacity.
struct CapacityUse {
  LinkNanoseconds at = 0;
  std::uint64_t opportunity = 0;      // the last one used, counted over all repetitions
  std::size_t opportunity_bytes = 0;  // already used of it
};

// How fast bytes pass: at once, at a rate that changes by steps, or at given moments.
class Capacity {
 public:
  Capacity() = default;
  explicit Capacity(double bit_s) : Capacity(std::vector<RateStep>{{{}, bit_s}}) {}
  // Precondition: rising times, the first at 0, no rate below 0.
  explicit Capacity(std::vector<RateStep> steps);
  // Precondition: as Opportunities says.
  explicit Capacity(Opportunities opportunities);

  // When so many bytes have passed if they begin at `start`, but not before the last ones ended.
  CapacityUse after(CapacityUse last, LinkNanoseconds start, std::size_t bytes) const;

 private:
  CapacityUse by_rate(LinkNanoseconds start, std::size_t bytes) const;
  CapacityUse by_opportunity(CapacityUse last, LinkNanoseconds start, std::size_t bytes) const;

  std::variant<std::monostate, std::vector<RateStep>, Opportunities> kind_;
};

}  // namespace warren
