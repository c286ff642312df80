// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/announcing.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace warren::replication {
Said::Thing Announcing::thing_of(const HeldLayer& layer) const {
  Said::Thing thing{{0, std::nullopt}, layer.version, layer.changed};
  if (layer.own != nullptr) return thing;
  const Pull* const pull = pulling_.find(layer);
  thing.way = pull == nullptr ? Way{} : Way{pull->hops, pull->provider};
  return thing;
}

bool Announcing::is_quiet(const HeldLayer& layer) const {
  return layer.stored == layer.replica().holdings() &&
         (layer.changed == MeshTime::min() ||
          node_.now >= layer.changed + node_.config.timers.quiet);
}

MeshTime Announcing::due(const HeldLayer& layer, Spoken& spoken) const {
  const Said::Thing thing = thing_of(layer);
  if (spoken.clock.ever()) return spoken.clock.due(node_.now, node_.config.timers, thing);
  const bool empty = layer.stored == Holdings() && thing.way.hops == kNoWay;
  return empty ? kNever : node_.now;
}

void Announcing::say(const HeldLayer& layer, Spoken& spoken) {
  const Said::Thing thing = thing_of(layer);
  Announcement announcement{layer.id,       layer.replica().resolution(),
                            thing.way.hops, thing.way.provider,
                            layer.stored,   std::nullopt};
  const bool quiet = is_quiet(layer);
  if (quiet && layer.stored.intervals().size() == 1 && layer.stored.at(0) > Revision{}) {
    announcement.digest = prefix_of(layer.replica().digest().root());
    walk_.look(layer);
  }
  spoken.clock.on_said(node_.now, thing, quiet);
  if (spoken.last == announcement) return;
  auto bytes = encode(announcement);
  ++sent_;
  sent_bytes_ += bytes.size();
  node_.commands.emplace_back(
      SetTelemetry{static_cast<std::uint16_t>(kLayerKeys + layer.slot), std::move(bytes)});
  spoken.last = std::move(announcement);
}

void Announcing::advance() {
  next_ = kNever;
  bool any = false;
  std::vector<std::pair<const HeldLayer*, Spoken*>> waiting;
  for (const auto& layer : node_.book.layers()) {
    Spoken& spoken = spoken_[layer->slot];
    const MeshTime when = due(*layer, spoken);
    if (when <= node_.now) {
      say(*layer, spoken);
      any = true;
      next_ = std::min(next_, due(*layer, spoken));
    } else if (when != kNever) {
      waiting.emplace_back(layer.get(), &spoken);
      next_ = std::min(next_, when);
    }
  }
  if (!any) return;
  // What would go soon goes along, in the same packets.
  for (const auto& [layer, spoken] : waiting) {
    if (node_.now >= spoken->clock.at() + node_.config.timers.refresh / 2) say(*layer, *spoken);
  }
}

}  // namespace warren::replication
