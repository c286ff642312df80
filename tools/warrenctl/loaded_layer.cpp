// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/loaded_layer.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

// A layer, and what an operator may call it.
struct Called {
  control::LayerId id;
  std::vector<std::string> names;

  bool is(const std::string& name) const {
    if (name.empty()) return false;
    return std::find(names.begin(), names.end(), name) != names.end() ||
           text_of(id).rfind(name, 0) == 0;
  }
};

tl::expected<std::vector<Called>, std::string> loaded_layers(const std::string& socket) {
  control::Request request;
  request.mutable_status();
  const auto response = ask_daemon(socket, request);
  if (!response) return tl::unexpected(response.error());
  std::vector<Called> layers;
  for (const control::LoadedLayer& layer : response->status().loaded()) {
    layers.push_back(
        {layer.layer(), {layer.file(), std::filesystem::path(layer.file()).filename()}});
  }
  return layers;
}

// How late a node began it; only of the one that it writes now it tells how much is known. A node
// that lost its disk counts from 0 again.
std::pair<bool, std::uint32_t> lateness(const control::FleetLayer& layer) {
  return {layer.has_lag_voxels(), layer.layer().number()};
}

// Those of others that the mesh keeps here; by a node's name the newest of them is meant.
tl::expected<std::vector<Called>, std::string> copied_layers(const std::string& socket) {
  control::Request request;
  request.mutable_fleet_status();
  const auto response = ask_daemon(socket, request);
  if (!response) return tl::unexpected(response.error());
  std::vector<Called> layers;
  for (const control::FleetNode& node : response->fleet_status().nodes()) {
    std::optional<std::size_t> newest;
    std::pair<bool, std::uint32_t> latest;
    for (const control::FleetLayer& layer : node.layers()) {
      if (layer.own()) continue;
      layers.push_back({layer.layer(), {}});
      if (newest && lateness(layer) < latest) continue;
      latest = lateness(layer);
      newest = layers.size() - 1;
    }
    if (newest && !node.name().empty()) layers[*newest].names.push_back(node.name());
  }
  return layers;
}

}  // namespace

tl::expected<control::LayerId, std::string> find_loaded_layer(const std::string& socket,
                                                              const std::string& name) {
  auto layers = loaded_layers(socket);
  if (!layers) return tl::unexpected(layers.error());
  const auto copied = copied_layers(socket);
  if (!copied) return tl::unexpected(copied.error());
  layers->insert(layers->end(), copied->begin(), copied->end());
  const Called* found = nullptr;
  for (const Called& layer : *layers) {
    if (!layer.is(name)) continue;
    if (found != nullptr) {
      return tl::unexpected(name + " may be " + text_of(found->id) + " or " + text_of(layer.id) +
                            ": give more of the id");
    }
    found = &layer;
  }
  if (found == nullptr) {
    return tl::unexpected("no loaded layer is called " + name +
                          "; status and fleet status list them");
  }
  return found->id;
}

}  // namespace warren
