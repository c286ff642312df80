// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "daemon/fleet/path_chunk.hpp"
#include "transport/mesh_time.hpp"

namespace warren {

// Thins the path of this node's sensor: a point per metre, or per ten seconds in which it moved at
// all. Cuts it into parts, and says when one is worth telling: when it is full, else at most every
// ten seconds.
class OwnPath {
 public:
  static constexpr double kStep_m = 1.0;
  static constexpr double kStir_m = 0.1;
  static constexpr Duration kEvery = std::chrono::seconds(10);

  // Of another layer than before the path goes on with this part.
  void begin(const LayerId& layer, std::uint32_t next_number);
  const std::optional<LayerId>& layer() const { return layer_; }

  // Where the sensor is now; then the part to tell, if it is time, or if `last`: this may be the
  // last word for long. Precondition: a layer was begun, and `point` lies in it.
  std::optional<PathChunk> note(MeshTime now, const PathPoint& point, bool last = false);

 private:
  bool is_worth_a_point(MeshTime now, const PathPoint& point) const;

  std::optional<LayerId> layer_;
  PathChunk open_;
  std::optional<PathPoint> before_;  // the last point kept
  MeshTime before_at_{};
  std::size_t told_points_ = 0;  // of the open part
  std::optional<MeshTime> told_at_;
};

}  // namespace warren
