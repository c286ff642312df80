// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "daemon/control/request.hpp"
#include "warren/control.pb.h"

namespace warren {

// What several requests have in them.

inline constexpr std::size_t kNodeNameBytesMax = 32;

using Doubles = google::protobuf::RepeatedField<double>;

inline MapSource source_of(control::MapSource source) {
  return source == control::MERGE ? MapSource::kMerge : MapSource::kSelf;
}

// Three coordinates from the `first` on, which must be there.
inline Eigen::Vector3d vector_at(const Doubles& field, int first) {
  return {field[first], field[first + 1], field[first + 2]};
}

}  // namespace warren
