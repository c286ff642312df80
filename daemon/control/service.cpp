// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/service.hpp"

#include <type_traits>
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>

#include "daemon/config/print.hpp"

namespace warren {

ControlService::ControlService(Dependencies dependencies)
    : parts_(std::move(dependencies)), subscriptions_(parts_.io, parts_.fleet) {}

ControlService::~ControlService() { files_.join(); }

Hurry ControlService::handle(const ControlRequest& request, const Respond& respond) {
  return std::visit(
      [&](const auto& body) -> Hurry {
        if constexpr (std::is_same_v<std::decay_t<decltype(body)>, BlocksQuestion>) {
          return subscriptions_.answer(body, respond);
        } else {
          answer(body, respond);
          return nullptr;
        }
      },
      request);
}

// The guards below keep the io_context running until the answer is back.

void ControlService::answer(const StatusQuestion&, const Respond& respond) {
  const bool asked = parts_.mapper.ask_status(
      [this, respond, guard = asio::make_work_guard(parts_.io)](const MapperStatus& mapper) {
        asio::post(parts_.io, [this, respond, mapper] { answer_status(mapper, respond); });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer_status(const MapperStatus& mapper, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, respond, mapper, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        asio::post(parts_.io, [this, respond, mapper, publishing = fleet.map.report()] {
          respond(encode_status(status(mapper, publishing)));
        });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const MapInfoQuestion&, const Respond& respond) {
  const bool asked = parts_.mapper.ask_status(
      [this, respond, guard = asio::make_work_guard(parts_.io)](const MapperStatus& mapper) {
        asio::post(parts_.io, [respond, map = mapper.map] { respond(encode_map_info(map)); });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const ConfigQuestion&, const Respond& respond) {
  respond(encode_config(print_config(parts_.config)));
}

void ControlService::answer(const GroundQuestion& question, const Respond& respond) {
  const auto tell = [this, respond, guard = asio::make_work_guard(parts_.io)](const auto& result) {
    asio::post(parts_.io,
               [respond, frame = result ? encode_ground(*result) : encode_error(result.error())] {
                 respond(frame);
               });
  };
  const bool asked = question.source == MapSource::kSelf
                         ? parts_.mapper.ask_ground(question, tell)
                         : parts_.fleet.ask([question, tell](const FleetParts& fleet) {
                             tell(fleet.map.ground(question));
                           });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const LayerDiffQuestion& question, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, question, respond, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        const auto diff = fleet.map.diff(question.keys, question.from);
        asio::post(parts_.io,
                   [respond, frame = diff ? encode_layer_diff(*diff) : encode_error(kNoMapYet)] {
                     respond(frame);
                   });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const FlushOrder&, const Respond& respond) {
  const bool asked = parts_.fleet.ask([this, respond, guard = asio::make_work_guard(parts_.io)](
                                          const FleetParts& fleet) {
    const auto flushed = fleet.map.flush();
    fleet.mesh.on_ticked({});
    asio::post(parts_.io, [respond, frame = flushed ? encode_layer_flushed(*flushed)
                                                    : encode_error(kNoMapYet)] { respond(frame); });
  });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const CellsQuestion& question, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, question, respond, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        const auto cells = fleet.map.cells(question);
        asio::post(parts_.io,
                   [respond, frame = cells ? encode_cells(*cells) : encode_error(cells.error())] {
                     respond(frame);
                   });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const RaysQuestion& question, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, question, respond, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        const auto rays = fleet.map.rays(question);
        asio::post(parts_.io,
                   [respond, frame = rays ? encode_rays(*rays) : encode_error(rays.error())] {
                     respond(frame);
                   });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const FleetStatusQuestion&, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, respond, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        asio::post(parts_.io,
                   [respond, frame = encode_fleet_status(fleet.mesh.report())] { respond(frame); });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const RetractOrder& order, const Respond& respond) {
  change_loaded([order](LoadedLayers& loaded) { return loaded.retract(order.layer); }, respond);
}

void ControlService::answer(const RestoreOrder& order, const Respond& respond) {
  change_loaded([order](LoadedLayers& loaded) { return loaded.restore(order.layer); }, respond);
}

void ControlService::answer(const MoveOrder& order, const Respond& respond) {
  change_loaded([order](LoadedLayers& loaded) { return loaded.move(order.layer, order.shift); },
                respond);
}

void ControlService::change_loaded(const LoadedLayersOrder& order, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, order, respond, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        const auto layer = order(fleet.map.loaded());
        asio::post(parts_.io,
                   [respond, frame = layer ? encode_loaded_layer(*layer)
                                           : encode_error(layer.error())] { respond(frame); });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

StatusReport ControlService::status(MapperStatus mapper, PublishingReport publishing) const {
  StatusReport report;
  report.node = parts_.config.node.name;
  report.version = parts_.version;
  report.uptime_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  report.ingest = parts_.ingest.status();
  report.queue = parts_.mapper.queue_load();
  report.mapper = std::move(mapper);
  report.publishing = std::move(publishing);
  report.publishing.ticks_late = parts_.fleet.ticks_late();
  report.store = parts_.fleet.store_status();
  return report;
}

}  // namespace warren
