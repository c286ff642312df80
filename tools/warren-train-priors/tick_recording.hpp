// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/layer/publisher.hpp"
#include "tools/world/world.hpp"

namespace warren {

// What a self-map's owner hands over at each tick.
using Tick = std::vector<CodedBlock>;
using Ticks = std::vector<Tick>;

struct MapSetting {
  double resolution_m = 0.15;
  double max_range_m = 10.0;
};

// The ticks, a second each, of a robot that explores a world for so long; one recording per
// setting. The same input gives the same ticks on the same CPU.
tl::expected<std::vector<Ticks>, std::string> record_ticks(const world::WorldSpec& world,
                                                           double seconds,
                                                           const std::vector<MapSetting>& settings);

// A single cloud as one tick, seen from where its sensor was: the origin of its frame.
tl::expected<Ticks, std::string> record_cloud(const std::filesystem::path& cloud,
                                              const MapSetting& setting);

// The same with so many ticks made one.
Ticks merge_ticks(const Ticks& ticks, std::size_t count);

// Publishes the ticks and hands out the packets that tell of each; or, if `snapshot`, those that
// tell of the whole in the end.
using PacketSink = std::function<void(const std::vector<std::uint8_t>&)>;
void send_ticks(const Ticks& ticks, const SenderRules& rules, bool snapshot,
                const PacketSink& sink);

}  // namespace warren
