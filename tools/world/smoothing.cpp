// SPDX-License-Identifier: Apache-2.0
#include "tools/world/smoothing.hpp"

#include <cmath>

namespace warren::world {
namespace {

std::vector<double> half_kernel(double sigma) {
  std::vector<double> weights;
  double sum = 0.0;
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  for (int i = 0; i <= reach; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += i == 0 ? weights.back() : 2.0 * weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

double mirrored(const std::vector<double>& values, std::ptrdiff_t index) {
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  if (last == 0) return values[0];
  if (index < 0) return 2.0 * values.front() - mirrored(values, std::min(-index, last));
  if (index > last)
    return 2.0 * values.back() - mirrored(values, std::max<std::ptrdiff_t>(2 * last - index, 0));
  return values[static_cast<std::size_t>(index)];
}

}  // namespace

std::vector<double> smoothed(const std::vector<double>& values, double sigma) {
  if (values.empty() || sigma <= 0.0) return values;
  const std::vector<double> weights = half_kernel(sigma);
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto centre = static_cast<std::ptrdiff_t>(i);
    out[i] = weights[0] * values[i];
    for (std::size_t k = 1; k < weights.size(); ++k) {
      const auto offset = static_cast<std::ptrdiff_t>(k);
      out[i] +=
          weights[k] * (mirrored(values, centre - offset) + mirrored(values, centre + offset));
    }
  }
  return out;
}

}  // namespace warren::world
