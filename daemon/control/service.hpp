// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include <asio/io_context.hpp>
#include <asio/thread_pool.hpp>

#include "core/exchange/map_writer.hpp"
#include "daemon/control/response.hpp"
#include "daemon/control/session.hpp"
#include "daemon/control/subscriptions.hpp"
#include "daemon/fleet/fleet.hpp"
#include "daemon/ingest/server.hpp"
#include "daemon/mapper/mapper.hpp"

namespace warren {

using MapSaver = std::function<tl::expected<SaveReport, std::string>(
    const MapSnapshot&, const std::filesystem::path&, PictureColours)>;

// Answers control requests: asks the mapping thread, reads and writes files on a worker of its own.
class ControlService {
 public:
  // A snapshot is a copy of the map, and a layer being loaded another one: memory bounds how many
  // may wait for the disk.
  static constexpr std::size_t kMaxPendingFiles = 2;
  static constexpr const char* kTooBusy = kTooManyQuestions;
  static constexpr const char* kBusyWithFiles = "busy with other files; try again";

  struct Dependencies {
    asio::io_context& io;
    Mapper& mapper;
    Fleet& fleet;
    const IngestServer& ingest;
    const Config& config;  // as it is in force
    MapSaver save_map;
    std::string version;
    std::chrono::steady_clock::duration file_time_max;  // that one may take
  };

  explicit ControlService(Dependencies dependencies);
  // Waits for files being read or written.
  ~ControlService();
  ControlService(const ControlService&) = delete;
  ControlService& operator=(const ControlService&) = delete;

  // False while the thread that reads and writes files has been with one for too long.
  bool files_progress() const {
    return pending_files_ == 0 ||
           std::chrono::steady_clock::now() < files_progress_ + parts_.file_time_max;
  }

  using Respond = std::function<void(std::string)>;
  Hurry handle(const ControlRequest& request, const Respond& respond);

 private:
  void answer(const StatusQuestion& question, const Respond& respond);
  void answer(const MapInfoQuestion& question, const Respond& respond);
  void answer(const ConfigQuestion& question, const Respond& respond);
  void answer(const SaveOrder& order, const Respond& respond);
  void answer(const GroundQuestion& question, const Respond& respond);
  void answer(const LayerDiffQuestion& question, const Respond& respond);
  void answer(const LoadOrder& order, const Respond& respond);
  void answer(const FlushOrder& order, const Respond& respond);
  void answer(const CellsQuestion& question, const Respond& respond);
  void answer(const RetractOrder& order, const Respond& respond);
  void answer(const RestoreOrder& order, const Respond& respond);
  void answer(const MoveOrder& order, const Respond& respond);
  void answer(const FleetStatusQuestion& question, const Respond& respond);
  void answer(const MessageSendOrder& order, const Respond& respond);
  void answer(const MessageWatchQuestion& question, const Respond& respond);
  void answer(const FleetOrder& order, const Respond& respond);
  void answer(const TrajectoryQuestion& question, const Respond& respond);
  void answer(const AlignEstimateQuestion& question, const Respond& respond);
  void ask_mesh(std::function<void(const FleetParts&, const Respond&)> act, const Respond& respond);
  void answer(const RaysQuestion& question, const Respond& respond);
  using LoadedLayersOrder = std::function<LoadedLayers::Result(LoadedLayers&)>;
  void change_loaded(const LoadedLayersOrder& order, const Respond& respond);
  void load(const LoadOrder& order, const Respond& done);
  void save_layer(const SaveOrder& order, const Respond& done);
  void save_copy(const SaveOrder& order, const Respond& done);
  void save_merged(const SaveOrder& order, const Respond& done);
  Respond begin_file_work(const Respond& respond);
  void save(const SaveOrder& order, const std::shared_ptr<const MapSnapshot>& snapshot,
            const Respond& respond);
  void answer_status(const MapperStatus& mapper, const Respond& respond);
  StatusReport status(MapperStatus mapper, PublishingReport publishing) const;

  Dependencies parts_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  Subscriptions subscriptions_;
  std::size_t pending_files_ = 0;
  std::chrono::steady_clock::time_point
      files_progress_{};  // one was begun by a free thread, or ended
  asio::thread_pool files_{1};
};

}  // namespace warren
