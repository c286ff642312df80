// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/voxel/point.hpp"

namespace warren {

// Vectors are read this far past the end of what is asked for: 16 floats of AVX-512.
inline constexpr std::size_t kVectorPadding = 16;

// Points that a search looks at, in ascending order of their indices in the cloud. Behind each
// array lie kVectorPadding more values, of any kind.
struct Candidates {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;
};

// Room for the candidates that pass a first look: their squared distances and offsets.
class NearCandidates {
 public:
  void reserve(std::size_t candidates);
  float* squared() { return rows_.data(); }
  float* x() { return rows_.data() + row_; }
  float* y() { return rows_.data() + 2 * row_; }
  float* z() { return rows_.data() + 3 * row_; }
  // As a number's bits: which candidate it was.
  float* number() { return rows_.data() + 4 * row_; }

 private:
  std::size_t row_ = 0;
  std::vector<float> rows_;
};

// Sums over the offsets of the k nearest from the point itself.
struct NearestSums {
  // x, y, z, xx, xy, xz, yy, yz, zz
  std::array<float, 9> moments{};
  float squared_radius = 0.0F;  // squared distance of the k-th
};

struct NearestQuery {
  Point3f centre;
  std::size_t k = 0;
  // A guess of the squared radius; any value gives the right answer, a good one a fast one.
  float guess = 0.0F;
};

// The k nearest of at least k candidates, the centre's own point among them; of those equally far,
// the first. Every CPU gives the same bits.
NearestSums find_nearest(const Candidates& candidates, const NearestQuery& query,
                         NearCandidates& near);
// The same, but their numbers among the candidates, ascending.
void list_nearest(const Candidates& candidates, const NearestQuery& query, NearCandidates& near,
                  std::span<std::uint32_t> numbers);

}  // namespace warren
