// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/service.hpp"

#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>

#include "core/exchange/file_ending.hpp"
#include "core/exchange/layer_file.hpp"
#include "daemon/config/print.hpp"
#include "daemon/fleet/earlier_layer.hpp"
#include "daemon/log.hpp"

namespace warren {
namespace {

constexpr const char* kBusyWithFiles = "busy with other files; try again";
constexpr const char* kTooBusy = "too many questions wait; try again";

using Saved = tl::expected<SaveReport, std::string>;

std::string encode_saved(const std::filesystem::path& file, const Saved& saved) {
  if (!saved) return encode_error(saved.error());
  log_info("control: saved " + file.string());
  return encode_map_saved(file.string(), *saved);
}

Saved save_merged_to(const SaveOrder& order, const MergedSnapshot* merged) {
  if (merged == nullptr) return tl::unexpected(std::string(kNoMapYet));
  return save_merged_map(*merged, order.path, order.colours);
}

Saved save_layer_to(const SaveOrder& order, const std::optional<EncodedLayer>& layer) {
  if (!layer) return tl::unexpected(std::string(kNoMapYet));
  const auto written = write_encoded_layer(layer->bytes, order.path);
  if (!written) return tl::make_unexpected(written.error());
  return SaveReport{"layer", layer->bytes.size(), layer->voxels, "as it is published"};
}

}  // namespace

ControlService::ControlService(Dependencies dependencies) : parts_(std::move(dependencies)) {}

ControlService::~ControlService() { files_.join(); }

void ControlService::handle(const ControlRequest& request, const Respond& respond) {
  std::visit([&](const auto& body) { answer(body, respond); }, request);
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
      [this, respond, mapper, guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
        asio::post(parts_.io, [this, respond, mapper, publishing = fleet.report()] {
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
  const bool asked =
      question.source == MapSource::kSelf
          ? parts_.mapper.ask_ground(question, tell)
          : parts_.fleet.ask([question, tell](FleetMap& fleet) { tell(fleet.ground(question)); });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const LoadOrder& order, const Respond& respond) {
  if (pending_files_ >= kMaxPendingFiles) return respond(encode_error(kBusyWithFiles));
  const Respond done = begin_file_work(respond);
  asio::post(files_,
             [this, order, done, guard = asio::make_work_guard(parts_.io)] { load(order, done); });
}

// On the worker.
void ControlService::load(const LoadOrder& order, const Respond& done) {
  const auto tell = [this, done, guard = asio::make_work_guard(parts_.io)](std::string frame) {
    asio::post(parts_.io, [done, frame = std::move(frame)] { done(frame); });
  };
  auto layer = read_earlier_layer(order.path);
  if (!layer) return tell(encode_error(layer.error()));
  const auto shared = std::make_shared<Replica>(std::move(*layer));
  const bool asked = parts_.fleet.ask([order, tell, shared](FleetMap& fleet) {
    const auto loaded = fleet.load(std::move(*shared), order.path.string());
    if (loaded) log_info("control: loaded " + order.path.string());
    tell(loaded ? encode_map_loaded(*loaded) : encode_error(loaded.error()));
  });
  if (!asked) tell(encode_error(kTooBusy));
}

void ControlService::answer(const LayerDiffQuestion& question, const Respond& respond) {
  const bool asked = parts_.fleet.ask([this, question, respond,
                                       guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
    const auto diff = fleet.diff(question.keys, question.from);
    asio::post(parts_.io, [respond, frame = diff ? encode_layer_diff(*diff)
                                                 : encode_error(kNoMapYet)] { respond(frame); });
  });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const FlushOrder&, const Respond& respond) {
  const bool asked = parts_.fleet.ask([this, respond,
                                       guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
    const auto flushed = fleet.flush();
    asio::post(parts_.io, [respond, frame = flushed ? encode_layer_flushed(*flushed)
                                                    : encode_error(kNoMapYet)] { respond(frame); });
  });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const CellsQuestion& question, const Respond& respond) {
  const bool asked = parts_.fleet.ask(
      [this, question, respond, guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
        const auto cells = fleet.cells(question);
        asio::post(parts_.io,
                   [respond, frame = cells ? encode_cells(*cells) : encode_error(cells.error())] {
                     respond(frame);
                   });
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
      [this, order, respond, guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
        const auto layer = order(fleet.loaded());
        asio::post(parts_.io,
                   [respond, frame = layer ? encode_loaded_layer(*layer)
                                           : encode_error(layer.error())] { respond(frame); });
      });
  if (!asked) respond(encode_error(kTooBusy));
}

ControlService::Respond ControlService::begin_file_work(const Respond& respond) {
  ++pending_files_;
  return [this, respond](std::string frame) {
    --pending_files_;
    respond(std::move(frame));
  };
}

void ControlService::answer(const SaveOrder& order, const Respond& respond) {
  if (pending_files_ >= kMaxPendingFiles) return respond(encode_error(kBusyWithFiles));
  const Respond done = begin_file_work(respond);
  if (order.source == MapSource::kMerge) return save_merged(order, done);
  if (lower_case_ending(order.path) == ".layer") return save_layer(order, done);
  const bool asked = parts_.mapper.ask_snapshot(
      [this, order, done, guard = asio::make_work_guard(parts_.io)](const auto& snapshot) {
        asio::post(files_, [this, order, done, guard, snapshot] { save(order, snapshot, done); });
      });
  if (!asked) done(encode_error(kTooBusy));
}

// On the worker.
void ControlService::save(const SaveOrder& order,
                          const std::shared_ptr<const MapSnapshot>& snapshot,
                          const Respond& respond) {
  std::string frame =
      snapshot ? encode_saved(order.path, parts_.save_map(*snapshot, order.path, order.colours))
               : encode_error(kNoMapYet);
  asio::post(parts_.io, [respond, frame = std::move(frame)] { respond(frame); });
}

void ControlService::save_layer(const SaveOrder& order, const Respond& done) {
  const bool asked = parts_.fleet.ask([this, order, done,
                                       guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
    asio::post(files_, [this, order, done, guard, layer = fleet.encoded_layer()] {
      asio::post(parts_.io, [done, frame = encode_saved(order.path, save_layer_to(order, layer))] {
        done(frame);
      });
    });
  });
  if (!asked) done(encode_error(kTooBusy));
}

void ControlService::save_merged(const SaveOrder& order, const Respond& done) {
  const bool asked = parts_.fleet.ask(
      [this, order, done, guard = asio::make_work_guard(parts_.io)](FleetMap& fleet) {
        asio::post(files_, [this, order, done, guard, merged = fleet.merged_snapshot()] {
          asio::post(parts_.io,
                     [done, frame = encode_saved(order.path, save_merged_to(order, merged.get()))] {
                       done(frame);
                     });
        });
      });
  if (!asked) done(encode_error(kTooBusy));
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
  return report;
}

}  // namespace warren
