// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/liveness.hpp"

#include <algorithm>

#include "transport/wire/beacon.hpp"

namespace warren::mesh {
namespace {

// A told period beyond these is nobody's: it must not keep a member up forever, nor let it flutter.
constexpr Duration kPeriodLeast = std::chrono::milliseconds(800);
constexpr Duration kPeriodMost = std::chrono::seconds(20);

bool within(MeshTime now, MeshTime then, Duration limit) {
  return then != MeshTime::min() && now - then <= limit;
}

}  // namespace

void Liveness::on_beacon(MeshTime now, Duration period, std::size_t crowd) {
  crowd_ = crowd;
  heard_ = now;
  period_ = std::clamp(period, kPeriodLeast, kPeriodMost);
}

void Liveness::on_pair_packet(MeshTime now) {
  heard_ = now;
  hears_us_ = now;
}

Duration Liveness::heard_limit() const { return std::max(kHeardLeast, kBeaconsMissed * period_); }

Duration Liveness::hears_us_limit() const {
  const auto beacons_for_all = static_cast<Duration::rep>(crowd_ / Beacon::kHeardMax);
  return kHearsUsFactor * (heard_limit() + beacons_for_all * period_);
}

std::optional<bool> Liveness::update(MeshTime now) {
  const bool up = within(now, heard_, heard_limit()) && within(now, hears_us_, hears_us_limit());
  if (up == up_) return std::nullopt;
  up_ = up;
  if (!up) hears_us_ = MeshTime::min();
  return up;
}

bool Liveness::overdue(MeshTime now) const {
  return !within(now, heard_, period_ + period_ / 2 + kPeriodLeast);
}

MeshTime Liveness::next() const {
  if (!up_) return kNever;
  return std::min(heard_ + heard_limit(), hears_us_ + hears_us_limit()) + Duration(1);
}

}  // namespace warren::mesh
