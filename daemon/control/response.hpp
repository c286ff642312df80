// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/exchange/map_writer.hpp"
#include "daemon/fleet/fleet_map.hpp"
#include "daemon/fleet/fleet_report.hpp"
#include "daemon/ingest/server_status.hpp"
#include "daemon/mapper/mapper.hpp"
#include "daemon/store/store_worker.hpp"

namespace warren {

inline constexpr const char* kTooManyQuestions = "too many questions wait; try again";

struct StatusReport {
  std::string node;
  std::string version;
  double uptime_s = 0.0;
  IngestStatus ingest;
  Mapper::QueueLoad queue;
  MapperStatus mapper;
  PublishingReport publishing;
  std::optional<StoreStatus> store;  // none: the node keeps nothing
};

// Responses as they go over the wire, length included.
std::string encode_status(const StatusReport& report);
std::string encode_map_info(const MapInfoReport& info);
std::string encode_map_saved(const std::string& path, const SaveReport& report);
std::string encode_layer_diff(const LayerDiff& diff);
std::string encode_layer_flushed(const FlushReport& report);
// To a load.
std::string encode_map_loaded(const LoadedLayer& layer);
// To a retraction, a restoration or a move.
std::string encode_loaded_layer(const LoadedLayer& layer);
std::string encode_ground(const GroundAnswer& answer);
std::string encode_cells(const CellsAnswer& answer);
std::string encode_blocks(const BlocksAnswer& answer);
std::string encode_rays(const RaysAnswer& answer);
std::string encode_fleet_status(const FleetReport& report);
std::string encode_config(const std::string& yaml);
std::string encode_error(const std::string& text);

}  // namespace warren
