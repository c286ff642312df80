// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "core/exchange/map_picture.hpp"
#include "core/layer/claim.hpp"
#include "core/terrain/ground.hpp"
#include "core/voxel/scan.hpp"
#include "daemon/control/blocks_cursor.hpp"
#include "daemon/control/fleet_request.hpp"
#include "daemon/control/layer_shift.hpp"

namespace warren {

inline constexpr std::size_t kMaxControlFrameBytes = 1048576;

struct StatusQuestion {};
struct MapInfoQuestion {};
struct ConfigQuestion {};
struct FleetStatusQuestion {};
enum class MapSource : std::uint8_t { kSelf, kMerge };
struct SaveOrder {
  std::filesystem::path path;  // absolute, without control characters
  PictureColours colours = PictureColours::kHeight;
  MapSource source = MapSource::kSelf;
  std::string of{};  // name of a node: its layer as it is copied here; empty: of this node
};
struct LoadOrder {
  std::filesystem::path path;  // absolute, without control characters
};
// Where somebody wants to stand.
struct GroundQuestion {
  MapSource source = MapSource::kSelf;
  Pose T_map_base;
  Footprint footprint;
  std::optional<double> above_m;  // none: GroundQuery's
  std::optional<double> below_m;
  std::optional<Eigen::Vector3d> gravity_map;  // any length; none: that of the scan taken last
  bool stair_capable = false;
  double unknown_up_to = 0.0;  // share of columns without a cost that is put up with, 0 to 1
};
// What does a copy of the own layer lack, that holds `from` in these keys?
struct LayerDiffQuestion {
  KeyInterval keys;
  Revision from;
};
// What is known in a box, by cells of the octree?
struct CellsQuestion {
  MapSource source = MapSource::kSelf;
  Eigen::Vector3d low_map;   // finite
  Eigen::Vector3d high_map;  // of a point: the same
  // The depth in the octree, 0 to 16; or the least edge of a cell, metres, positive.
  std::variant<std::uint32_t, double> size;
};
// A box of the map frame, finite.
struct MapBox {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};
// What changed in a map since a copy of it was last told? May wait for something to change.
struct BlocksQuestion {
  static constexpr std::size_t kBytesMin = 4096;
  static constexpr std::size_t kBytesMax = 1048576;
  static constexpr double kWaitMost_s = 60.0;
  static constexpr double kRateLeast_hz = 0.1;
  static constexpr double kRateMost_hz = 10.0;

  MapSource source = MapSource::kSelf;
  std::optional<MapBox> box;           // none: everywhere
  std::optional<BlocksCursor> cursor;  // of this source and box; none: the copy is empty
  std::size_t most_bytes = 262144;
  double wait_s = 0.0;
  double rate_hz = 1.0;

  // The same number for the same source and box.
  std::uint64_t scope() const;
};
struct MapRay {
  Eigen::Vector3d origin_map;     // finite
  Eigen::Vector3d direction_map;  // of unit length
};
// What is the first that rays meet?
struct RaysQuestion {
  static constexpr std::size_t kRaysMax = 1024;

  MapSource source = MapSource::kSelf;
  std::vector<MapRay> rays;
  double max_range_m = 0.0;      // finite, positive
  bool through_unknown = false;  // only what is occupied stops them
};
struct FlushOrder {};
struct RetractOrder {
  LayerId layer;
};
struct RestoreOrder {
  LayerId layer;
};
struct MoveOrder {
  LayerId layer;
  LayerShift shift;
};
using ControlRequest =
    std::variant<StatusQuestion, MapInfoQuestion, ConfigQuestion, SaveOrder, GroundQuestion,
                 LayerDiffQuestion, LoadOrder, FlushOrder, RetractOrder, RestoreOrder, MoveOrder,
                 CellsQuestion, FleetStatusQuestion, MessageSendOrder, MessageWatchQuestion,
                 FleetOrder, TrajectoryQuestion, AlignEstimateQuestion, BlocksQuestion,
                 RaysQuestion>;

// The error says what is wrong with the request.
tl::expected<ControlRequest, std::string> decode_control_request(std::span<const std::byte> bytes);

}  // namespace warren
