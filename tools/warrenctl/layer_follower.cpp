// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/layer_follower.hpp"

#include <span>

#include "warren/control.pb.h"

namespace warren {
namespace {

LayerId id_of(const control::LayerId& id) { return {id.origin(), id.number(), id.incarnation()}; }

std::span<const std::uint8_t> bytes_of(const std::string& packet) {
  return {reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()};
}

}  // namespace

tl::expected<std::uint64_t, std::string> LayerFollower::catch_up() {
  std::uint64_t bytes = 0;
  std::optional<BlockOrdinal> next_key = 0;
  while (next_key) {
    auto taken = ask_from(*next_key, next_key);
    if (!taken) return taken;
    bytes += *taken;
  }
  return bytes;
}

tl::expected<std::uint64_t, std::string> LayerFollower::ask_from(
    BlockOrdinal first_key, std::optional<BlockOrdinal>& next_key) {
  control::Request request;
  auto& question = *request.mutable_layer_diff();
  question.set_from(copy_ ? copy_->holdings().lowest({first_key, kOrdinalEnd}).number : 0);
  question.set_first_key(first_key);
  const auto response = ask_(request);
  if (!response) return tl::unexpected(response.error());
  const control::LayerDiff& diff = response->layer_diff();
  const auto resolution = Resolution::from_micrometres(diff.resolution_um());
  if (!resolution) return tl::unexpected(std::string("the layer has no usable resolution"));
  const LayerId id = id_of(diff.layer());
  next_key.reset();
  if (!copy_ || copy_->id() != id) {
    const bool had_another = copy_.has_value();
    begin_layer(id, *resolution);
    // These packets tell what is new since a revision of the layer before.
    if (had_another) {
      next_key = 0;
      return 0;
    }
  }
  std::uint64_t bytes = 0;
  for (const std::string& packet : diff.packets()) {
    if (copy_->apply(id, bytes_of(packet)) == ApplyResult::kApplied) bytes += packet.size();
  }
  if (diff.has_next_key() && diff.next_key() > first_key) next_key = diff.next_key();
  return bytes;
}

void LayerFollower::begin_layer(const LayerId& id, Resolution resolution) {
  changed_.clear();
  copy_.emplace(id, resolution);
  copy_->on_change([this](BlockOrdinal block) { changed_.insert(block); });
}

}  // namespace warren
