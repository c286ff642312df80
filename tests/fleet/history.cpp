// SPDX-License-Identifier: Apache-2.0
#include "tests/fleet/history.hpp"

namespace warren::fleet_sim {

void History::record(const Replica& layer, const std::vector<BlockOrdinal>& written) {
  Layer& known = layers_[layer.id()];
  const Revision now = layer.holdings().at(0);
  // Who writes a revision again, as after a crash before it was stored, rewrites history: copies
  // that have the first one will differ from it.
  for (auto& [block, versions] : known.blocks) {
    while (!versions.empty() && versions.back().revision >= now) versions.pop_back();
  }
  for (const BlockOrdinal block : written) {
    known.blocks[block].push_back({now, layer.codes(block)});
  }
  known.latest = now;
}

const CodeBlock& History::at(const Versions& versions, Revision revision) {
  static const CodeBlock kEmpty;
  for (auto version = versions.rbegin(); version != versions.rend(); ++version) {
    if (version->revision <= revision) return version->codes;
  }
  return kEmpty;
}

std::optional<std::string> History::fault_of(const Replica& replica) const {
  const auto known = layers_.find(replica.id());
  if (known == layers_.end()) {
    return replica.holdings() == Holdings() ? std::nullopt
                                            : std::optional<std::string>("a layer of nobody");
  }
  const Layer& layer = known->second;
  if (replica.holdings().highest({}) > layer.latest) return "a revision that was never written";
  for (const auto& [block, versions] : layer.blocks) {
    const Revision held = replica.holdings().at(block);
    if (replica.codes_in_place(block) != at(versions, held)) {
      return "block " + std::to_string(block) + " is not as of revision " +
             std::to_string(held.number);
    }
  }
  std::optional<std::string> fault;
  replica.for_each_changed({}, Revision{}, [&](BlockOrdinal block, const LayerBlock& found) {
    if (!found.codes.empty() && !layer.blocks.contains(block)) {
      fault = "block " + std::to_string(block) + " was never written";
    }
    return !fault.has_value();
  });
  return fault;
}

Revision History::latest(const LayerId& layer) const {
  const auto known = layers_.find(layer);
  return known == layers_.end() ? Revision{} : known->second.latest;
}

std::vector<BlockOrdinal> History::written(const LayerId& layer) const {
  std::vector<BlockOrdinal> written;
  const auto known = layers_.find(layer);
  if (known == layers_.end()) return written;
  for (const auto& [block, versions] : known->second.blocks) written.push_back(block);
  return written;
}

}  // namespace warren::fleet_sim
