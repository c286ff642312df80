// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>

#include "daemon/config/config.hpp"
#include "daemon/control/server.hpp"
#include "daemon/control/service.hpp"
#include "daemon/fleet/fleet.hpp"
#include "daemon/ingest/server.hpp"
#include "daemon/mapper/mapper.hpp"
#include "daemon/node_start.hpp"
#include "daemon/socket_file.hpp"
#include "daemon/watchdog.hpp"

namespace warren {

// The composition root: all parts of the daemon and what connects them. It lives on the thread
// that runs the io_context; the functions that say so may be called from any.
class Warrend {
 public:
  struct Dependencies {
    MapSaver save_map;
    // Tells the service manager, in sd_notify's words.
    std::function<void(const std::string&)> notify = [](const std::string&) {};
    std::optional<std::chrono::microseconds> watchdog_time{};
    std::function<void()> before_scan = [] {};  // tests hold the mapping thread here
    // After that long with one file the thread that reads and writes them counts as hanging.
    std::chrono::steady_clock::duration file_time_max = std::chrono::minutes(10);
  };

  // Opens the sockets and starts the mapping thread. The error says what to do. The file is what a
  // reload reads; the io_context must outlive the result.
  static tl::expected<std::unique_ptr<Warrend>, std::string> start(
      asio::io_context& io, const Config& config, const std::filesystem::path& config_file,
      Dependencies dependencies);

  // Any thread. Stops taking scans, integrates and answers what has arrived, gives neighbours a
  // moment to take it, then lets io_context::run() return.
  void request_stop();
  // Any thread. Reads the config file again and takes over what a running daemon can; a faulty
  // file changes nothing.
  void request_reload();

 private:
  Warrend(asio::io_context& io, const Config& config, std::filesystem::path config_file,
          const FleetConfig& fleet, NodeStart node, std::optional<SocketFile> ingest_socket,
          SocketFile control_socket, Dependencies dependencies);

  Mapper::Dependencies mapper_dependencies();
  ControlService::Dependencies service_dependencies();
  void stop();
  void on_drained();
  void on_mapper_finished(std::vector<LayerChanges> last);
  void on_fleet_finished();
  void reload();
  void apply(const Config& wanted);

  asio::io_context& io_;
  asio::executor_work_guard<asio::io_context::executor_type> running_;
  Config config_;
  std::filesystem::path config_file_;
  Dependencies dependencies_;
  std::optional<SocketFile> ingest_socket_;
  SocketFile control_socket_;
  bool stopping_ = false;
  Fleet fleet_;  // outlives the mapping thread, which hands over to it
  Mapper mapper_;
  IngestServer ingest_;
  ControlService service_;
  ControlServer control_;
  Watchdog watchdog_;
};

}  // namespace warren
