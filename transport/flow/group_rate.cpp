// SPDX-License-Identifier: Apache-2.0
#include "transport/flow/group_rate.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

using std::chrono::milliseconds;

constexpr Duration kShort = milliseconds{20};
constexpr Duration kLong = milliseconds{60};
constexpr Duration kRaiseEvery = milliseconds{100};
constexpr Duration kLowerEvery = milliseconds{200};
constexpr double kRaise = 1.25;
constexpr double kLower = 0.7;
// A buffer too short for a queue to show would let the rate grow without end.
constexpr double kAboveFastest = 4.0;

}  // namespace

void GroupRate::on_acknowledged(MeshTime now, bool wanted, Duration standing, double slowest,
                                double fastest) {
  const bool lowers = standing > kLong;
  const bool raises = standing < kShort && wanted;
  if ((!lowers && !raises) || now - changed_ < (lowers ? kLowerEvery : kRaiseEvery)) return;
  changed_ = now;
  rate_ = std::clamp(pace(slowest) * (lowers ? kLower : kRaise), slowest,
                     std::max(slowest, kAboveFastest * fastest));
}

double GroupRate::pace(double slowest) const { return std::max(rate_, slowest); }

}  // namespace warren::mesh
