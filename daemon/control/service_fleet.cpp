// SPDX-License-Identifier: Apache-2.0
// What ControlService has the fleet's desk do.
#include <chrono>
#include <memory>
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>

#include "core/exchange/layer_file.hpp"
#include "daemon/control/fleet_desk_response.hpp"
#include "daemon/control/service.hpp"
#include "daemon/fleet/wall_clock.hpp"

namespace warren {
namespace {

constexpr const char* kMeshOff = "the mesh is off: the config names no interface";

// Two layers to be compared, as they were on the fleet thread.
struct LayerPair {
  std::vector<std::uint8_t> layer;
  std::vector<std::uint8_t> against;
};

tl::expected<LayerPair, std::string> layers_of(const FleetParts& fleet,
                                               const AlignEstimateQuestion& question) {
  const FleetDesk& desk = fleet.mesh.desk();
  const auto layer_of = [&](const std::string& name) -> tl::expected<const Replica*, std::string> {
    const auto node = desk.find_node(name);
    if (!node) return tl::unexpected(node.error());
    return desk.newest_layer(*node);
  };
  const auto layer = layer_of(question.node);
  if (!layer) return tl::unexpected(layer.error());
  LayerPair pair{FleetMap::encoded(**layer).bytes, {}};
  if (!question.against.empty()) {
    const auto against = layer_of(question.against);
    if (!against) return tl::unexpected(against.error());
    pair.against = FleetMap::encoded(**against).bytes;
    return pair;
  }
  auto own = fleet.map.encoded_layer();
  if (!own) {
    return tl::unexpected(std::string(
        "this node has measured nothing itself: name another node to compare with (--against)"));
  }
  pair.against = std::move(own->bytes);
  return pair;
}

// On the worker.
std::string estimated(const LayerPair& pair) {
  const auto layer = decode_layer(pair.layer);
  const auto against = decode_layer(pair.against);
  if (!layer) return encode_error(text_of(layer.error()));
  if (!against) return encode_error(text_of(against.error()));
  const auto result = register_layers(*layer, *against);
  if (!result) return encode_error(result.error());
  return encode_align_estimate(layer->id(), against->id(), *result);
}

}  // namespace

// `act` is called on the fleet thread with the mesh, and tells its answer once, there as well.
void ControlService::ask_mesh(std::function<void(const FleetParts&, const Respond&)> act,
                              const Respond& respond) {
  const Respond tell = [this, respond,
                        guard = asio::make_work_guard(parts_.io)](std::string frame) {
    asio::post(parts_.io, [respond, frame = std::move(frame)] { respond(frame); });
  };
  const bool asked = parts_.fleet.ask([act = std::move(act), tell](const FleetParts& fleet) {
    fleet.mesh.is_on() ? act(fleet, tell) : tell(encode_error(kMeshOff));
  });
  if (!asked) respond(encode_error(kTooBusy));
}

void ControlService::answer(const MessageSendOrder& order, const Respond& respond) {
  ask_mesh(
      [order](const FleetParts& fleet, const Respond& tell) {
        fleet.mesh.desk().send(
            mesh::MeshRunner::now(), order, wall_clock_us(), [tell](const auto& number) {
              tell(number ? encode_message_accepted(*number) : encode_error(number.error()));
            });
      },
      respond);
}

void ControlService::answer(const MessageWatchQuestion& question, const Respond& respond) {
  ask_mesh(
      [question](const FleetParts& fleet, const Respond& tell) {
        FleetDesk& desk = fleet.mesh.desk();
        InboxReport report;
        report.excerpt = desk.read(mesh::MeshRunner::now(), question);
        for (const InboxMessage& message : report.excerpt.messages) {
          report.senders.push_back(fleet.mesh.name_of(message.from));
        }
        report.dropped = desk.messages().dropped();
        tell(encode_messages(report));
      },
      respond);
}

void ControlService::answer(const FleetOrder& order, const Respond& respond) {
  ask_mesh(
      [order](const FleetParts& fleet, const Respond& tell) {
        fleet.mesh.desk().order(mesh::MeshRunner::now(), order, [tell](const auto& layers) {
          tell(layers ? encode_fleet_ordered(*layers) : encode_error(layers.error()));
        });
      },
      respond);
}

void ControlService::answer(const TrajectoryQuestion& question, const Respond& respond) {
  ask_mesh(
      [question](const FleetParts& fleet, const Respond& tell) {
        const auto path = fleet.mesh.desk().path(question);
        tell(path ? encode_trajectory(question.node, *path) : encode_error(path.error()));
      },
      respond);
}

void ControlService::answer(const AlignEstimateQuestion& question, const Respond& respond) {
  if (pending_files_ >= kMaxPendingFiles) return respond(encode_error(kBusyWithFiles));
  ask_mesh(
      [this, question](const FleetParts& fleet, const Respond& tell) {
        auto pair = layers_of(fleet, question);
        if (!pair) return tell(encode_error(pair.error()));
        const auto shared = std::make_shared<const LayerPair>(std::move(*pair));
        asio::post(files_, [tell, shared] { tell(estimated(*shared)); });
      },
      begin_file_work(respond));
}

}  // namespace warren
