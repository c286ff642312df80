// SPDX-License-Identifier: Apache-2.0
#include "daemon/warrend.hpp"

#include <utility>

#include <asio/post.hpp>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "daemon/fleet_setup.hpp"
#include "daemon/ingest/header.hpp"
#include "daemon/log.hpp"
#include "daemon/node_start.hpp"

namespace warren {
namespace {

SensorFilters filters_of(const Config& config) {
  SensorFilters filters;
  for (const SensorConfig& sensor : config.sensors) filters[sensor.name] = sensor.filter();
  return filters;
}

MappingConfig mapping_config(const Config& config) {
  return {config.self_map(), config.terrain.resolved(), config.node.fleet_T_map.pose(),
          config.store.enabled};
}

// A base takes no scans.
tl::expected<std::optional<SocketFile>, std::string> listen_for_scans(const Config& config) {
  if (config.node.role == Role::kBase) return std::nullopt;
  auto socket = SocketFile::listen(config.sockets.ingest);
  if (!socket) return tl::unexpected(socket.error());
  return std::optional<SocketFile>(std::move(*socket));
}

std::string greeting(const Config& config) {
  std::string text = config.node.name + ": ready";
  if (config.node.role == Role::kRobot) text += ", scans to " + config.sockets.ingest.path.string();
  if (!config.mesh.is_on()) return text + ", alone: the config names no mesh interface";
  text += ", mesh on";
  for (const MeshInterfaceConfig& interface : config.mesh.interfaces) text += " " + interface.name;
  return text;
}

}  // namespace

tl::expected<std::unique_ptr<Warrend>, std::string> Warrend::start(
    asio::io_context& io, const Config& config, const std::filesystem::path& config_file,
    Dependencies dependencies) {
  silence_protobuf();
  const auto fleet = fleet_config_of(config);
  if (!fleet) return tl::unexpected(fleet.error());
  auto ingest = listen_for_scans(config);
  if (!ingest) return tl::unexpected(ingest.error());
  auto control = SocketFile::listen(config.sockets.control);
  if (!control) return tl::unexpected(control.error());
  auto node = start_node(config);
  if (!node) return tl::unexpected(node.error());
  std::unique_ptr<Warrend> warrend(new Warrend(io, config, config_file, *fleet, std::move(*node),
                                               std::move(*ingest), std::move(*control),
                                               std::move(dependencies)));
  warrend->ingest_.start();
  warrend->control_.start();
  warrend->fleet_.start();
  const auto& watchdog_time = warrend->dependencies_.watchdog_time;
  if (watchdog_time) warrend->watchdog_.start(*watchdog_time);
  warrend->dependencies_.notify("READY=1\nSTATUS=Mapping");
  log_info(greeting(config));
  return warrend;
}

Warrend::Warrend(asio::io_context& io, const Config& config, std::filesystem::path config_file,
                 const FleetConfig& fleet, NodeStart node, std::optional<SocketFile> ingest_socket,
                 SocketFile control_socket, Dependencies dependencies)
    : io_(io),
      running_(asio::make_work_guard(io)),
      config_(config),
      config_file_(std::move(config_file)),
      dependencies_(std::move(dependencies)),
      ingest_socket_(std::move(ingest_socket)),
      control_socket_(std::move(control_socket)),
      fleet_(io, mapper_, fleet, std::move(node.fleet)),
      mapper_(mapping_config(config), filters_of(config), config.ingest.queue_scans,
              mapper_dependencies(), std::move(node.map)),
      ingest_(io,
              ingest_socket_ ? std::optional(ingest_socket_->release_descriptor()) : std::nullopt,
              config, mapper_),
      service_(service_dependencies()),
      control_(io, control_socket_.release_descriptor(),
               [this](const ControlRequest& request, const ControlService::Respond& respond) {
                 return service_.handle(request, respond);
               }),
      watchdog_(io, mapper_, fleet_, [this] {
        if (service_.files_progress()) dependencies_.notify("WATCHDOG=1");
      }) {}

Mapper::Dependencies Warrend::mapper_dependencies() {
  const auto deliver = [this](const QueuedScan& scan, const ScanReceipt& receipt) {
    asio::post(io_, [this, client = scan.client, sensor = scan.message.sensor, receipt] {
      ingest_.deliver(client, sensor, receipt);
    });
  };
  return {deliver, dependencies_.before_scan};
}

ControlService::Dependencies Warrend::service_dependencies() {
  return {io_,
          mapper_,
          fleet_,
          ingest_,
          config_,
          dependencies_.save_map,
          WARREN_VERSION,
          dependencies_.file_time_max};
}

void Warrend::request_stop() {
  asio::post(io_, [this] { stop(); });
}

void Warrend::request_reload() {
  asio::post(io_, [this] { reload(); });
}

void Warrend::stop() {
  if (std::exchange(stopping_, true)) return;
  log_info("stopping: integrating what has arrived");
  dependencies_.notify("STOPPING=1\nSTATUS=Integrating what has arrived");
  control_.finish();
  ingest_.drain([this] { on_drained(); });
}

void Warrend::on_drained() {
  mapper_.finish([this](std::vector<LayerChanges> last) {
    asio::post(io_,
               [this, last = std::move(last)]() mutable { on_mapper_finished(std::move(last)); });
  });
}

void Warrend::on_mapper_finished(std::vector<LayerChanges> last) {
  fleet_.finish(std::move(last), [this] { asio::post(io_, [this] { on_fleet_finished(); }); });
}

// All receipts have been posted before.
void Warrend::on_fleet_finished() {
  ingest_.finish();
  watchdog_.stop();
  running_.reset();
}

void Warrend::reload() {
  if (stopping_) return;
  dependencies_.notify("RELOADING=1");
  const auto loaded = load_config(config_file_);
  if (loaded) {
    apply(*loaded);
  } else {
    log_error("reload: the config stays as it is");
    for (const std::string& fault : loaded.error()) log_error("reload: " + fault);
  }
  dependencies_.notify(loaded ? "READY=1\nSTATUS=Mapping"
                              : "READY=1\nSTATUS=Mapping; the config file has faults, see the log");
}

void Warrend::apply(const Config& wanted) {
  const ConfigChanges changes = compare_configs(config_, wanted);
  config_ = reloaded(config_, wanted);
  set_log_level(config_.log.level);
  mapper_.set_filters(filters_of(config_));
  mapper_.set_queue_capacity(config_.ingest.queue_scans);
  ingest_.reconfigure(config_);
  for (const std::string& key : changes.effective) log_info("reload: " + key + " changed");
  for (const std::string& key : changes.needs_restart) {
    log_warning("reload: " + key + " differs in the file; that needs a restart");
  }
  if (changes.effective.empty() && changes.needs_restart.empty()) log_info("reload: no change");
}

}  // namespace warren
