// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <optional>

namespace warren {

// Edge of a layer's voxels in whole micrometres, so that resolutions compare exactly. Invariant:
// 1 mm to 10 m.
class Resolution {
 public:
  static constexpr std::uint32_t kMinimum_um = 1000;
  static constexpr std::uint32_t kMaximum_um = 10'000'000;

  constexpr Resolution() = default;  // 0.1 m
  // Nothing outside the range.
  static constexpr std::optional<Resolution> from_micrometres(std::uint32_t micrometres) {
    if (micrometres < kMinimum_um || micrometres > kMaximum_um) return std::nullopt;
    return Resolution(micrometres);
  }
  // The nearest whole micrometre; nothing outside the range.
  static std::optional<Resolution> from_metres(double metres) {
    const double micrometres = std::round(metres * 1e6);
    if (!(micrometres >= kMinimum_um && micrometres <= kMaximum_um)) return std::nullopt;
    return Resolution(static_cast<std::uint32_t>(micrometres));
  }

  constexpr std::uint32_t micrometres() const { return micrometres_; }
  // The double nearest to the decimal number: 0.15 is 0.15.
  constexpr double metres() const { return micrometres_ / 1e6; }

  friend auto operator<=>(const Resolution&, const Resolution&) = default;

 private:
  explicit constexpr Resolution(std::uint32_t micrometres) : micrometres_(micrometres) {}

  std::uint32_t micrometres_ = 100'000;
};

// What maps have unless told otherwise: 0.1 m.
inline constexpr Resolution kDefaultResolution{};

}  // namespace warren
