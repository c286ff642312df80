// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/layer/replica.hpp"

namespace warren::fleet_sim {

// What every layer of the fleet was at every revision, as its writer wrote it. Only the simulation
// knows all of it.
class History {
 public:
  // The layer as it is now has this revision; these blocks were written in it.
  void record(const Replica& layer, const std::vector<BlockOrdinal>& written);
  // Nothing if every block of the replica is the writer's at the revision held there; else what is
  // wrong.
  std::optional<std::string> fault_of(const Replica& replica) const;
  Revision latest(const LayerId& layer) const;
  std::size_t blocks(const LayerId& layer) const { return written(layer).size(); }
  // All blocks that ever were written.
  std::vector<BlockOrdinal> written(const LayerId& layer) const;

 private:
  struct Version {
    Revision revision;
    CodeBlock codes;
  };
  using Versions = std::vector<Version>;
  struct Layer {
    Revision latest;
    std::map<BlockOrdinal, Versions> blocks;
  };
  static const CodeBlock& at(const Versions& versions, Revision revision);

  std::map<LayerId, Layer> layers_;
};

}  // namespace warren::fleet_sim
