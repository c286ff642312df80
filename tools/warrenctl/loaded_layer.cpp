// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/loaded_layer.hpp"

#include <filesystem>

#include "tools/warrenctl/ask.hpp"
#include "tools/warrenctl/tables.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

bool is_called(const control::LoadedLayer& layer, const std::string& name) {
  if (name.empty()) return false;
  return name == layer.file() || name == std::filesystem::path(layer.file()).filename() ||
         text_of(layer.layer()).rfind(name, 0) == 0;
}

}  // namespace

tl::expected<control::LayerId, std::string> find_loaded_layer(const std::string& socket,
                                                              const std::string& name) {
  control::Request request;
  request.mutable_status();
  const auto response = ask_daemon(socket, request);
  if (!response) return tl::unexpected(response.error());
  const control::LoadedLayer* found = nullptr;
  for (const control::LoadedLayer& layer : response->status().loaded()) {
    if (!is_called(layer, name)) continue;
    if (found != nullptr) {
      return tl::unexpected(name + " may be " + text_of(found->layer()) + " or " +
                            text_of(layer.layer()) + ": give more of the id");
    }
    found = &layer;
  }
  if (found == nullptr) {
    return tl::unexpected("no loaded layer is called " + name + "; status lists them");
  }
  return found->layer();
}

}  // namespace warren
