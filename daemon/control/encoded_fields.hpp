// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "core/layer/claim.hpp"
#include "core/voxel/block_store.hpp"
#include "warren/control.pb.h"

namespace warren {

// What several responses have in them.

inline void add_vector(const Eigen::Vector3d& v, google::protobuf::RepeatedField<double>& field) {
  for (const double coordinate : v) field.Add(coordinate);
}

using Counts = google::protobuf::RepeatedPtrField<control::Count>;

inline void add_count(const std::string& name, std::uint64_t count, Counts& counts) {
  auto* const entry = counts.Add();
  entry->set_name(name);
  entry->set_count(count);
}

inline void fill(const LayerId& id, control::LayerId& message) {
  message.set_origin(id.origin);
  message.set_number(id.number);
  message.set_incarnation(id.incarnation);
}

inline const char* name_of(VoxelState state) {
  if (state == VoxelState::kOccupied) return "occupied";
  return state == VoxelState::kFree ? "free" : "unknown";
}

}  // namespace warren
