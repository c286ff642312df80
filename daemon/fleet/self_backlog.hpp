// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "daemon/store/store_batch.hpp"

namespace warren {

// What of the self-map waits to be stored: of each block its latest state.
class SelfBacklog {
 public:
  void add(SelfLayerWrite write);
  bool empty() const { return waiting_.empty(); }
  // Taken until on_stored() or on_refused() says what became of it.
  std::vector<SelfLayerWrite> take();
  void on_stored() { under_way_.clear(); }
  void on_refused();

 private:
  struct Layer {
    SelfLayerHead head;
    std::map<BlockOrdinal, BlockState> blocks;
  };
  std::map<std::uint32_t, Layer> waiting_;        // by number
  std::map<std::uint32_t, Layer> under_way_;      // likewise
  std::map<std::uint32_t, SelfLayerHead> taken_;  // as they were added last
};

}  // namespace warren
