// SPDX-License-Identifier: Apache-2.0
// What ControlService reads from and writes to files.
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>

#include "core/exchange/file_ending.hpp"
#include "core/exchange/layer_file.hpp"
#include "daemon/control/service.hpp"
#include "daemon/fleet/earlier_layer.hpp"
#include "daemon/log.hpp"

namespace warren {
namespace {

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

// What is no .layer file is in the layer frame.
Saved save_copy_to(const SaveOrder& order, const std::optional<EncodedLayer>& layer) {
  if (!layer) {
    return tl::unexpected("no layer of " + order.of + " is copied here; fleet status lists them");
  }
  if (lower_case_ending(order.path) == ".layer") return save_layer_to(order, layer);
  const auto copy = decode_layer(layer->bytes);
  if (!copy) return tl::unexpected(std::string(text_of(copy.error())));
  return export_layer(*copy, order.path);
}

}  // namespace

// The guards below keep the io_context running until the answer is back.

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
  const bool asked = parts_.fleet.ask([order, tell, shared](const FleetParts& fleet) {
    const auto loaded = fleet.map.load(std::move(*shared), order.path.string());
    if (loaded) log_info("control: loaded " + order.path.string());
    tell(loaded ? encode_map_loaded(*loaded) : encode_error(loaded.error()));
  });
  if (!asked) tell(encode_error(kTooBusy));
}

ControlService::Respond ControlService::begin_file_work(const Respond& respond) {
  if (pending_files_++ == 0) files_progress_ = std::chrono::steady_clock::now();
  return [this, respond](std::string frame) {
    --pending_files_;
    files_progress_ = std::chrono::steady_clock::now();
    respond(std::move(frame));
  };
}

void ControlService::answer(const SaveOrder& order, const Respond& respond) {
  if (pending_files_ >= kMaxPendingFiles) return respond(encode_error(kBusyWithFiles));
  const Respond done = begin_file_work(respond);
  if (!order.of.empty() && order.of != parts_.config.node.name) return save_copy(order, done);
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
  const bool asked = parts_.fleet.ask([this, order, done, guard = asio::make_work_guard(parts_.io)](
                                          const FleetParts& fleet) {
    asio::post(files_, [this, order, done, guard, layer = fleet.map.encoded_layer()] {
      asio::post(parts_.io, [done, frame = encode_saved(order.path, save_layer_to(order, layer))] {
        done(frame);
      });
    });
  });
  if (!asked) done(encode_error(kTooBusy));
}

void ControlService::save_copy(const SaveOrder& order, const Respond& done) {
  const bool asked = parts_.fleet.ask([this, order, done, guard = asio::make_work_guard(parts_.io)](
                                          const FleetParts& fleet) {
    const Replica* const copy = fleet.mesh.newest_copy_of(order.of);
    std::optional<EncodedLayer> layer;
    if (copy != nullptr) layer = FleetMap::encoded(*copy);
    asio::post(files_, [this, order, done, guard, layer = std::move(layer)] {
      asio::post(parts_.io, [done, frame = encode_saved(order.path, save_copy_to(order, layer))] {
        done(frame);
      });
    });
  });
  if (!asked) done(encode_error(kTooBusy));
}

void ControlService::save_merged(const SaveOrder& order, const Respond& done) {
  const bool asked = parts_.fleet.ask(
      [this, order, done, guard = asio::make_work_guard(parts_.io)](const FleetParts& fleet) {
        const auto merged = fleet.map.merged_snapshot();
        if (merged) {
          merged->name_others([&](const LayerId& layer) {
            const MemberId writer{layer.origin};
            return fleet.mesh.knows_name_of(writer) ? fleet.mesh.name_of(writer) : "";
          });
        }
        asio::post(files_, [this, order, done, guard, merged] {
          asio::post(parts_.io,
                     [done, frame = encode_saved(order.path, save_merged_to(order, merged.get()))] {
                       done(frame);
                     });
        });
      });
  if (!asked) done(encode_error(kTooBusy));
}

}  // namespace warren
